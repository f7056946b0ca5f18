#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "render/reference/brf_trace.hpp"
#include "render/scene.hpp"

namespace sunfleck::apps {

// The reflectance factors that `sunfleck trace` is asked for.
struct BrfOptions {
  std::string range;  // FROM:TO:STEP of view zeniths in the principal plane [degree]
  std::string views;  // CSV file of view directions
  double paths = 1e5;
  std::string csv, mes;  // files to write
  bool only = false;
  bool asked() const { return !range.empty() || !views.empty(); }
};
void addBrfOptions(CLI::App& command, BrfOptions& options);

// A view as it was asked for: a negative zenith is on the other side of the vertical.
struct BrfView {
  double zenith_deg = 0.;   // -89 .. 89; in the principal plane > 0 on the sun's side
  double azimuth_deg = 0.;  // of positive zeniths: where the viewer stands, from +x towards +y
  std::string name;         // "brf:ZENITH" in the principal plane, "brf:ZENITH:AZIMUTH" of a file of views
  ViewDirection direction;
};

// The views asked for. Throws InvalidInput on a range or a file that is wrong, and on options that lack one.
std::vector<BrfView> brfViews(const BrfOptions& options, const Scene& scene);

}  // namespace sunfleck::apps
