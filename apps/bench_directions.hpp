#pragma once

#include "apps/run_options.hpp"
#include "apps/scene_options.hpp"

namespace sunfleck::apps {

// `sunfleck bench directions`: how the G-factor converges with its sample directions. Returns the exit status.
int runBenchDirections(const SceneOptions& scene, const std::string& folder, const RunOptions& run);

}  // namespace sunfleck::apps
