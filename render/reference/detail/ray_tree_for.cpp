// Compiled once for each instruction set (sunfleck_kernel in cmake/module.cmake); of those, 16 lanes alone beat Embree.
#include "render/reference/detail/ray_tree_nodes.hpp"

#ifdef __AVX512F__
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"  // false, of GCC 12's own intrinsics
#endif
#include <immintrin.h>

namespace sunfleck::avx512 {
namespace {

using namespace detail;

constexpr int kMostWaiting = 2048;  // nodes of one tree, see ray_trees.cpp

// Of nodes and leaves to come, the next one last.
struct Waiting {
  alignas(64) float distance[kMostWaiting];
  alignas(64) std::int32_t node[kMostWaiting];
  int count;
};

struct Ray {
  __m512 from[3], direction[3], inverse[3], offset[3];
  int near_low[3];  // whether the box's low side is the one that the ray comes to first
  unsigned octant;

  Ray(const float* at, const float* along) : octant(0) {
    for (int axis = 0; axis < 3; ++axis) {
      constexpr float kSteep = 1e-18f;
      const float d = along[axis];
      const float inverted = d < kSteep && d > -kSteep ? (d < 0.f ? -1.f : 1.f) / kSteep : 1.f / d;
      from[axis] = _mm512_set1_ps(at[axis]);
      direction[axis] = _mm512_set1_ps(d);
      inverse[axis] = _mm512_set1_ps(inverted);
      offset[axis] = _mm512_set1_ps(-at[axis] * inverted);
      near_low[axis] = inverted >= 0.f;
      octant |= static_cast<unsigned>(inverted < 0.f) << axis;
    }
  }
};

// Puts the boxes that the ray meets before `reach` on the list, the nearest last, without a branch.
inline void visit(const BoxNode& node, const Ray& ray, __m512 reach, Waiting& waiting) {
  __m512 enters = _mm512_setzero_ps(), leaves = reach;
  for (int axis = 0; axis < 3; ++axis) {
    const float* sides[2] = {node.high[axis], node.low[axis]};
    const float *near = sides[ray.near_low[axis]], *far = sides[1 - ray.near_low[axis]];
    enters = _mm512_max_ps(_mm512_fmadd_ps(_mm512_load_ps(near), ray.inverse[axis], ray.offset[axis]), enters);
    leaves = _mm512_min_ps(_mm512_fmadd_ps(_mm512_load_ps(far), ray.inverse[axis], ray.offset[axis]), leaves);
  }
  const __m512i order = _mm512_cvtepu8_epi32(_mm_load_si128(reinterpret_cast<const __m128i*>(node.order[ray.octant])));
  enters = _mm512_permutexvar_ps(order, enters);
  leaves = _mm512_permutexvar_ps(order, leaves);
  const __m512i child = _mm512_permutexvar_epi32(order, _mm512_load_si512(node.child));
  const __mmask16 met = _mm512_cmp_ps_mask(enters, leaves, _CMP_LE_OQ);
  _mm512_storeu_ps(waiting.distance + waiting.count, _mm512_maskz_compress_ps(met, enters));
  _mm512_storeu_si512(waiting.node + waiting.count, _mm512_maskz_compress_epi32(met, child));
  waiting.count += __builtin_popcount(met);
}

struct LeafHits {
  __mmask16 met;
  __m512 distance;
};

inline __m512 dot(const float (*lanes)[16], const __m512* with) {
  return _mm512_fmadd_ps(
      _mm512_load_ps(lanes[0]), with[0],
      _mm512_fmadd_ps(_mm512_load_ps(lanes[1]), with[1], _mm512_mul_ps(_mm512_load_ps(lanes[2]), with[2])));
}

// (R36)
inline LeafHits meet(const FacetLeaf& leaf, const Ray& ray, __m512 reach) {
  const __m512 zero = _mm512_setzero_ps(), one = _mm512_set1_ps(1.f);
  const __m512 t = _mm512_div_ps(_mm512_sub_ps(_mm512_load_ps(leaf.plane[3]), dot(leaf.plane, ray.from)),
                                 dot(leaf.plane, ray.direction));
  __m512 point[3];
  for (int axis = 0; axis < 3; ++axis) point[axis] = _mm512_fmadd_ps(t, ray.direction[axis], ray.from[axis]);
  const __m512 u = _mm512_add_ps(dot(leaf.u, point), _mm512_load_ps(leaf.u[3]));
  const __m512 v = _mm512_add_ps(dot(leaf.v, point), _mm512_load_ps(leaf.v[3]));
  const __mmask16 parallelogram = _mm512_movepi32_mask(_mm512_load_si512(leaf.facet));
  const __mmask16 triangle = _mm512_cmp_ps_mask(_mm512_add_ps(u, v), one, _CMP_LE_OQ);
  __mmask16 met = _mm512_cmp_ps_mask(_mm512_min_ps(u, v), zero, _CMP_GE_OQ);
  met = _mm512_mask_cmp_ps_mask(met, _mm512_max_ps(u, v), one, _CMP_LE_OQ);
  met = _mm512_mask_cmp_ps_mask(met, t, zero, _CMP_GT_OQ);
  met = _mm512_mask_cmp_ps_mask(met, t, reach, _CMP_LT_OQ);
  return {static_cast<__mmask16>(met & (parallelogram | triangle)), t};
}

// Takes the next of those that begin before `reach` off the list.
inline bool next(Waiting& waiting, float reach, std::int32_t& node) {
  while (waiting.count > 0)
    if (waiting.distance[--waiting.count] < reach) {
      node = waiting.node[waiting.count];
      return true;
    }
  return false;
}

// Of one tree; `met` knows how far to look, and changes where something is nearer.
template <bool kAny>
bool meetTree(const FacetTreeView& tree, const float* from, const float* direction, FacetMet& met) {
  const Ray ray(from, direction);
  Waiting waiting;
  waiting.count = 0;
  __m512 reach = _mm512_set1_ps(met.distance);
  const FacetLeaf* first = nullptr;
  unsigned lane = 0;
  std::int32_t node = 0;
  do {
    if (node >= 0) {
      visit(tree.nodes[node], ray, reach, waiting);
      continue;
    }
    const FacetLeaf& leaf = tree.leaves[~node];
    const LeafHits hits = meet(leaf, ray, reach);
    if (hits.met == 0) continue;
    if (kAny) return true;
    met.distance = _mm512_mask_reduce_min_ps(hits.met, hits.distance);
    reach = _mm512_set1_ps(met.distance);
    first = &leaf;
    lane = static_cast<unsigned>(__builtin_ctz(_mm512_mask_cmp_ps_mask(hits.met, hits.distance, reach, _CMP_EQ_OQ)));
  } while (next(waiting, met.distance, node));
  if (!first) return false;
  met.facet = first->facet[lane];
  for (int i = 0; i < 4; ++i) met.plane[i] = first->plane[i][lane];
  return true;
}

template <bool kAny>
bool meetAll(const RayTreesView& trees, const float* from, const float* direction, FacetMet& met) {
  met.copy = 0;
  if (!trees.top) return meetTree<kAny>(trees.kinds[0], from, direction, met);
  const Ray ray(from, direction);
  Waiting waiting;
  waiting.count = 0;
  bool found = false;
  std::int32_t node = 0;
  do {
    if (node >= 0) {
      visit(trees.top[node], ray, _mm512_set1_ps(met.distance), waiting);
      continue;
    }
    const PlacedTree& copy = trees.copies[~node];
    const float c = copy.cosine, s = copy.sine, x = from[0] - copy.move[0], y = from[1] - copy.move[1];
    const float its_from[3] = {c * x + s * y, c * y - s * x, from[2] - copy.move[2]};
    const float its_direction[3] = {c * direction[0] + s * direction[1], c * direction[1] - s * direction[0],
                                    direction[2]};
    if (!meetTree<kAny>(trees.kinds[copy.kind], its_from, its_direction, met)) continue;
    found = true;
    if (kAny) return true;
    met.copy = static_cast<std::uint32_t>(~node);
  } while (next(waiting, met.distance, node));
  return found;
}

}  // namespace

bool closestFacet(const RayTreesView& trees, const float* from, const float* direction, float reach, FacetMet& met) {
  met.distance = reach;
  return meetAll<false>(trees, from, direction, met);
}

bool anyFacet(const RayTreesView& trees, const float* from, const float* direction, float reach) {
  FacetMet met;
  met.distance = reach;
  return meetAll<true>(trees, from, direction, met);
}

}  // namespace sunfleck::avx512
#endif
