#pragma once

#include <cstddef>
#include <cstdint>

namespace sunfleck::detail {

// Sixteen boxes around what lies below, empty ones around nothing; a ray tests all of them side by side.
struct alignas(64) BoxNode {
  static constexpr std::size_t kSize = 16;
  float low[3][kSize], high[3][kSize];  // [m]
  std::int32_t child[kSize];            // a node, or the complement of a leaf's number
  std::uint8_t order[8][kSize];         // of the boxes from far to near, for the signs of a ray's direction
};

// (R36) Sixteen facets. A ray meets one's plane after (plane[3] - plane . from) / (plane . direction), at a point p of
// coordinates u[3] + u . p and v[3] + v . p along its edges.
struct alignas(64) FacetLeaf {
  static constexpr std::size_t kSize = 16;
  static constexpr std::uint32_t kParallelogram = 1u << 31, kWood = 1u << 30, kNumber = kWood - 1;
  float plane[4][kSize], u[4][kSize], v[4][kSize];
  std::uint32_t facet[kSize];  // number of the primitive, and what it is
};

struct FacetTreeView {
  const BoxNode* nodes;
  const FacetLeaf* leaves;
};

// A copy of a prototype: rotated about z, then moved.
struct PlacedTree {
  float cosine, sine, move[3];  // [1], [m]
  std::uint32_t kind;
};

struct RayTreesView {
  const BoxNode* top;  // whose leaves are single copies; none where the first tree stands alone, as it is
  const PlacedTree* copies;
  const FacetTreeView* kinds;
};

struct FacetMet {
  float distance;       // [m]
  std::uint32_t facet;  // as FacetLeaf::facet
  std::uint32_t copy;   // 0 where a tree stands alone
  float plane[4];       // unit normal n, and n . x on it [m], in the tree before it was rotated and moved
};

// Whether a ray meets anything before `reach`; the first that it meets, or that something is.
using ClosestFacet = bool(const RayTreesView& trees, const float* from, const float* direction, float reach,
                          FacetMet& met);
using AnyFacet = bool(const RayTreesView& trees, const float* from, const float* direction, float reach);

}  // namespace sunfleck::detail

#ifdef SUNFLECK_X86
namespace sunfleck::avx512 {
detail::ClosestFacet closestFacet;
detail::AnyFacet anyFacet;
}  // namespace sunfleck::avx512
#endif
