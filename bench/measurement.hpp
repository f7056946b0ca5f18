#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <string>

#include "core/tree_mesh.hpp"
#include "plants/random_leaves.hpp"

namespace sunfleck {

// Runs a program that measures: reads its command line, then calls `measure`. Returns the exit status: 2 on bad input,
// of which it says what is wrong.
int measurement(const std::string& program, int argc, char** argv, const std::function<void(CLI::App&)>& add_options,
                const std::function<void()>& measure);

// A tree by the name of its species or its file, or "crown" of random leaves.
TreeMesh measuredTree(const std::string& name, std::uint64_t seed, const RandomCrown& crown = {});

}  // namespace sunfleck
