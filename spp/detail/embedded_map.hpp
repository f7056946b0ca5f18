#pragma once

#include <string_view>

namespace sunfleck::spp::detail {

// The file particle_errors.map, as it was when this was built.
std::string_view embeddedParticleErrors();

}  // namespace sunfleck::spp::detail
