#pragma once

#include <glm/vec3.hpp>

#include "plants/weber_penn.hpp"

namespace sunfleck::detail {

// Width of the pruning envelope over its largest [1], `ratio` 0 at the top of the crown and 1 at its base; 0 beyond.
double envelopeWidth(const WeberPenn& parameters, double ratio);

// Whether a point [m] lies within the envelope of a tree `height` [m] tall.
bool insideEnvelope(const WeberPenn& parameters, double height, const glm::dvec3& point);

}  // namespace sunfleck::detail
