#pragma once

#include <string_view>

namespace sunfleck::spp::detail {

// The files particle_errors.map and leaf_errors.map, as they were when this was built.
std::string_view embeddedParticleErrors();
std::string_view embeddedLeafErrors();

}  // namespace sunfleck::spp::detail
