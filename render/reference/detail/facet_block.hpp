#pragma once

#include <array>
#include <cstddef>

namespace sunfleck::detail {

// Sixteen facets as lines of one direction meet them. For a line at x and y across that direction, and a point on it at
// z along it: it meets a facet where 0 <= u, v and u + v - min(u, v) [if a parallelogram] <= 1; the point is before it
// where its side is below 0. All three are linear; a lane of no facet has u = -1.
struct alignas(64) FacetBlock {
  static constexpr std::size_t kSize = 16;
  using Lanes = std::array<float, kSize>;  // a line of the cache
  Lanes u, u_x, u_y, v, v_x, v_y, side, side_x, side_y, side_z, parallelogram;
};

// Whether a point is before a facet of any of the blocks `first` .. `last`, one beyond.
using BeforeFacet = bool(const FacetBlock* first, const FacetBlock* last, float x, float y, float z);
// The build of it that suits the machine.
BeforeFacet* beforeFacet();

}  // namespace sunfleck::detail

namespace sunfleck::baseline {
detail::BeforeFacet beforeFacet;
}
#ifdef SUNFLECK_X86
namespace sunfleck::avx2 {
detail::BeforeFacet beforeFacet;
}
namespace sunfleck::avx512 {
detail::BeforeFacet beforeFacet;
}
#endif
