// Compiled once for each instruction set (sunfleck_kernel in cmake/module.cmake).
#include "render/reference/detail/facet_block.hpp"

namespace sunfleck::SUNFLECK_ISA {

bool beforeFacet(const detail::FacetBlock* first, const detail::FacetBlock* last, float x, float y, float z) {
  for (; first != last; ++first) {
    const detail::FacetBlock& of = *first;
    int any = 0;
    for (std::size_t k = 0; k < detail::FacetBlock::kSize; ++k) {
      const float u = of.u[k] + x * of.u_x[k] + y * of.u_y[k], v = of.v[k] + x * of.v_x[k] + y * of.v_y[k];
      const float side = of.side[k] + x * of.side_x[k] + y * of.side_y[k] + z * of.side_z[k];
      const float least = u < v ? u : v;
      any |= static_cast<int>(least >= 0.f) & static_cast<int>(u + v - of.parallelogram[k] * least <= 1.f) &
             static_cast<int>(side < 0.f);
    }
    if (any != 0) return true;
  }
  return false;
}

}  // namespace sunfleck::SUNFLECK_ISA
