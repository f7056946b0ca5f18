#pragma once

#include <cstddef>
#include <string>

#include "apps/run_options.hpp"

namespace sunfleck::apps {

// `sunfleck bench forest`: what the light field of stands of very many trees costs. Returns the exit status.
int runBenchForest(std::size_t most_trees, std::size_t most_near, const std::string& folder, const RunOptions& run);

}  // namespace sunfleck::apps
