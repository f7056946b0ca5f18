// Compiled once for each instruction set (sunfleck_kernel in cmake/module.cmake).
#include <cstddef>

#include "spp/detail/lanes.hpp"

namespace sunfleck::spp::SUNFLECK_ISA {

// out[i] = sum over j = 1 .. exponentials of e^(-j x[i]); count is a multiple of the lanes.
extern void (*const sumExponentials)(std::size_t count, const float* x, int exponentials, float* out);
void (*const sumExponentials)(std::size_t, const float*, int, float*) = [](std::size_t count, const float* x,
                                                                           int exponentials, float* out) {
  for (std::size_t i = 0; i < count; i += kLanes) {
    Lanes lanes, sum = 0.f;
    __builtin_memcpy(&lanes, x + i, sizeof lanes);
    for (int j = 1; j <= exponentials; ++j) sum += exp(Lanes(static_cast<float>(-j)) * lanes);
    __builtin_memcpy(out + i, &sum, sizeof sum);
  }
};

}  // namespace sunfleck::spp::SUNFLECK_ISA
