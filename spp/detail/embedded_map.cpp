#include "spp/detail/embedded_map.hpp"

// The assembler takes the files in as they are, by directives and names that assemblers of ELF files know: those of
// other systems have sections and names of their own.
asm(R"(
.section .rodata
sunfleck_particle_errors:
.incbin ")" SUNFLECK_MAPS R"(/particle_errors.map"
sunfleck_particle_errors_end:
sunfleck_leaf_errors:
.incbin ")" SUNFLECK_MAPS R"(/leaf_errors.map"
sunfleck_leaf_errors_end:
.previous
)");
extern "C" const char sunfleck_particle_errors[], sunfleck_particle_errors_end[];
extern "C" const char sunfleck_leaf_errors[], sunfleck_leaf_errors_end[];

namespace sunfleck::spp::detail {

std::string_view embeddedParticleErrors() {
  return {sunfleck_particle_errors, sunfleck_particle_errors_end};
}

std::string_view embeddedLeafErrors() {
  return {sunfleck_leaf_errors, sunfleck_leaf_errors_end};
}

}  // namespace sunfleck::spp::detail
