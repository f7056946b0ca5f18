#pragma once

#include <cstddef>
#include <string>

#include "apps/run_options.hpp"

namespace sunfleck::apps {

// `sunfleck bench stand`: what stands of trees cost to prepare and to change. Returns the exit status.
int runBenchStand(std::size_t most_trees, int rounds, const std::string& folder, const RunOptions& run);

}  // namespace sunfleck::apps
