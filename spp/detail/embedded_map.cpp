#include "spp/detail/embedded_map.hpp"

// The assembler takes the file in as it is.
asm(R"(
.section .rodata
sunfleck_particle_errors:
.incbin ")" SUNFLECK_PARTICLE_ERRORS R"("
sunfleck_particle_errors_end:
.previous
)");
extern "C" const char sunfleck_particle_errors[], sunfleck_particle_errors_end[];

namespace sunfleck::spp::detail {

std::string_view embeddedParticleErrors() {
  return {sunfleck_particle_errors, sunfleck_particle_errors_end};
}

}  // namespace sunfleck::spp::detail
