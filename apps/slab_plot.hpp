#pragma once

#include <span>
#include <string>

#include "apps/slab_options.hpp"

namespace sunfleck::apps {

// The radiance in the principal plane at the question's depths by each model, and the first model's at the middle one
// over all directions, as SVG text. Without depths: the top, the middle and the bottom.
std::string slabPlot(std::span<const SlabModel* const> models, const SlabQuestion& question, bool logarithmic);

}  // namespace sunfleck::apps
