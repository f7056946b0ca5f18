#pragma once

#include <string>
#include <vector>

#include "apps/display_options.hpp"
#include "apps/run_options.hpp"
#include "apps/scene_options.hpp"

namespace sunfleck::apps {

struct PictureBenchOptions {
  std::vector<std::string> scenes{"cherry16", "maple16"};
  CameraOptions camera;
  DisplayOptions display;
  int samples = 64;
};
void addPictureBenchOptions(CLI::App& command, PictureBenchOptions& options);

// (R31) Draws each scene by each model, holds the pictures against one by Monte Carlo, and writes a table of their
// errors and, for each scene, a sheet of all pictures and of their differences in false colours.
int runBenchPictures(const PictureBenchOptions& options, const std::string& folder, const RunOptions& run);

}  // namespace sunfleck::apps
