#pragma once

#include <CLI/CLI.hpp>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "apps/brf_options.hpp"
#include "apps/pictures.hpp"
#include "apps/run_part.hpp"
#include "apps/scene_options.hpp"

namespace sunfleck::apps {

// What `sunfleck trace` is asked for.
struct TraceOptions {
  SceneOptions scene;
  CameraOptions camera;
  std::optional<double> paths;  // 4e6, or without end where there is a target
  BrfOptions brf;
  int samples = 64;
  int band = 0;
  DisplayOptions display;
  bool by_eye = false, all_bands = false, without_wood = false, only_picture = false;
  std::string leaves, picture, cells, spectrum, spectrum_out;
  double cell = 0.25;             // side [m]
  std::vector<float> other_leaf;  // reflectance, transmittance
  std::optional<float> turbid;    // side of a cell [m]
  std::string checkpoint, target, time, part, compare;
  double write_every = 60.;  // [s]
};
void addTraceOptions(CLI::App& command, TraceOptions& options);

// How long and how far a run goes.
struct Extent {
  double target = 0.;  // relative error to reach; 0: none
  double seconds = std::numeric_limits<double>::infinity();
  RunPart part;
};
// Throws InvalidInput on a target, a time or a part that is none.
Extent extentOf(const TraceOptions& options);

}  // namespace sunfleck::apps
