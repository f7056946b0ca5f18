#include "spp/compensation.hpp"

#include <algorithm>
#include <cassert>

#include "spp/detail/array_kernel.hpp"
#include "spp/slab.hpp"

namespace sunfleck::spp {

float compensation(std::span<const float> cosines, std::span<const float> edges, float depth, float thickness,
                   float mu0) {
  assert(cosines.size() == edges.size() && !cosines.empty());
  float lost = 0.f;
  for (std::size_t j = 0; j < cosines.size(); ++j) lost += shareBeyondEdge(cosines[j], edges[j], depth, thickness, mu0);
  return std::clamp(1.f - lost / static_cast<float>(cosines.size()), 0.f, 1.f);
}

void compensation(std::span<const float> cosines, std::span<const float> edges, std::span<const float> depth,
                  std::span<const float> thickness, float mu0, std::span<float> compensation) {
  assert(!cosines.empty() && edges.size() == cosines.size() * depth.size() && thickness.size() == depth.size() &&
         compensation.size() == depth.size());
  detail::arrayKernel().compensation({.count = depth.size(), .depth = depth.data(), .thickness = thickness.data()},
                                     {.count = cosines.size(), .cosines = cosines.data(), .distances = edges.data()},
                                     mu0, compensation.data());
}

}  // namespace sunfleck::spp
