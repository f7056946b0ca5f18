#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "render/reference/detail/leaf_sides.hpp"
#include "render/reference/trace_light.hpp"

namespace sunfleck::detail {

// (R20) A leaf under a gloss that is the same everywhere and on both sides. So one of rho + tau = 1 sends on all light
// of each direction.
template <int N>
class GlossyLeaf {
 public:
  GlossyLeaf(const std::vector<TraceLight>& bands, std::uint32_t kind)
      : lobe_(std::make_shared<const LeafGloss>(bands.front().ofKind(kind).leaf.gloss_roughness)),
        sides_(sidesOf(bands, kind, *lobe_)) {}

  // As SceneOptics' functions of these names, with `normal` on the side that the path arrives at.
  Onward scatter(const glm::vec3& normal, const glm::vec3& arriving, BandLanes<N>& weight, PathRandom& random) const {
    return sides_.scatter(normal, arriving, weight, random);
  }
  BandLanes<N> sent(const glm::vec3& normal, const glm::vec3& arriving, const glm::vec3& to_light) const {
    return sides_.sent(normal, arriving, to_light);
  }
  float density(const glm::vec3& normal, const glm::vec3& arriving, const BandLanes<N>& weight,
                const glm::vec3& direction) const {
    return sides_.density(normal, arriving, weight, direction);
  }

 private:
  static LeafSides<N> sidesOf(const std::vector<TraceLight>& bands, std::uint32_t kind, const LeafGloss& lobe) {
    typename LeafSides<N>::Side side{.lobe = &lobe, .gloss = {}};
    SurfaceOptics<N> optics;
    for (std::size_t b = 0; b < bands.size(); ++b) {
      const LeafOptics leaf = bands[b].ofKind(kind).leaf;
      const int band = static_cast<int>(b);
      side.gloss[band] = leaf.gloss;
      optics.reflectance[band] = leaf.reflectance;
      optics.transmittance[band] = leaf.transmittance;
    }
    return LeafSides<N>(side, side, optics);
  }

  std::shared_ptr<const LeafGloss> lobe_;  // of copies the same
  LeafSides<N> sides_;
};

}  // namespace sunfleck::detail
