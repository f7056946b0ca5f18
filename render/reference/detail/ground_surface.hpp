#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include "render/reference/detail/cosine_law.hpp"
#include "render/reference/detail/scattering.hpp"
#include "render/reference/detail/scene_geometry.hpp"
#include "render/reference/trace_light.hpp"

namespace sunfleck::detail {

// A ground that differs from place to place, or with the angles (R21).
template <int N>
class GroundSurface {
 public:
  // `scene` must outlive it. Nothing where the ground is the same everywhere and reflects by Lambert's law.
  static std::optional<GroundSurface> of(const std::vector<TraceLight>& bands, const RayScene::Geometry& scene) {
    if (!bands.front().ground_rpv && !bands.front().ground_texture) return std::nullopt;
    return GroundSurface(bands, scene);
  }

  // As SceneOptics' functions of these names. Directions come by the law of cosines, so that a weight changes by the
  // reflectance factor, which is bounded.
  Onward scatter(const Hit& hit, const glm::vec3& arriving, BandLanes<N>& weight, PathRandom& random) const {
    Onward onward{.side = hit.normal, .direction = lambertDirection(hit.normal, random)};
    weight *= factor(hit, arriving, onward.direction);
    if (survives(weight, random)) onward.fate = Fate::reflected;
    return onward;
  }

  BandLanes<N> sent(const Hit& hit, const glm::vec3& arriving, const glm::vec3& to_light) const {
    if (!(to_light.z > 0.f)) return {};
    BandLanes<N> share = factor(hit, arriving, to_light);
    share *= to_light.z * std::numbers::inv_pi_v<float>;
    return share;
  }

  float density(const glm::vec3& direction) const { return std::max(direction.z, 0.f) * std::numbers::inv_pi_v<float>; }

 private:
  GroundSurface(const std::vector<TraceLight>& bands, const RayScene::Geometry& scene) : scene_(&scene) {
    for (const TraceLight& light : bands) {
      if (light.ground_rpv) rpv_.push_back(*light.ground_rpv);
      if (light.ground_texture) textures_.push_back(light.ground_texture);
    }
  }

  // Bidirectional reflectance factors [1].
  BandLanes<N> factor(const Hit& hit, const glm::vec3& arriving, const glm::vec3& to_light) const {
    BandLanes<N> factors;
    int band = 0;
    for (const RpvGround& ground : rpv_) factors[band++] = rpvReflectance(ground, -arriving, to_light);
    if (textures_.empty()) return factors;
    const glm::dvec3 place =
        glm::dvec3(scene_->period ? scene_->wrapped(hit.position) : hit.position) + glm::dvec3(scene_->origin);
    for (const auto& texture : textures_) factors[band++] = texture->at(place.x, place.y);
    return factors;
  }

  const RayScene::Geometry* scene_;
  std::vector<RpvGround> rpv_;  // of each band, or
  std::vector<std::shared_ptr<const GroundTexture>> textures_;
};

}  // namespace sunfleck::detail
