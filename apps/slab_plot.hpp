#pragma once

#include <span>
#include <string>
#include <vector>

#include "apps/slab_options.hpp"

namespace sunfleck::apps {

// The question's depths; without any: the top, the middle and the bottom.
std::vector<double> plotDepths(const SlabQuestion& question);

// The radiance in the principal plane at these depths by each model, and the first model's at the middle one over all
// directions, as SVG text.
std::string slabPlot(std::span<const SlabModel* const> models, const SlabQuestion& question, bool logarithmic);

}  // namespace sunfleck::apps
