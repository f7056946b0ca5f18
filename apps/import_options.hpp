#pragma once

#include <string>
#include <vector>

#include "apps/run_options.hpp"
#include "plants/import.hpp"

namespace sunfleck::apps {

// How a command reads a mesh file.
struct ImportOptions {
  std::string up, unit, cards;
  float scale = 1.f;  // [m]
  std::vector<std::string> leaf, wood;
  std::string mesh;

  // The first of them that was given, such as "--leaf"; nullptr: none.
  const char* given() const;
  // Throws InvalidInput on a name that is not known.
  ImportRules rules() const;
};

// Adds --leaf, --wood, --scale, --unit, --up, --cards and --mesh.
void addImportOptions(CLI::App& command, ImportOptions& options);

}  // namespace sunfleck::apps
