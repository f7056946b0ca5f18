#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <numbers>

#include "render/reference/detail/cosine_law.hpp"
#include "render/reference/detail/scattering.hpp"

namespace sunfleck::detail {

// A surface that scatters by Lambert's law on both sides. As SceneOptics' functions of these names, with `normal` on
// the side that the path arrives at.
template <int N>
struct LambertSurface {
  const SurfaceOptics<N>& optics;

  Onward scatter(const glm::vec3& normal, const glm::vec3& /*arriving*/, BandLanes<N>& weight,
                 PathRandom& random) const {
    Onward onward{.fate = detail::scatter(optics, weight, random)};
    if (onward.fate == Fate::absorbed) return onward;
    onward.side = onward.fate == Fate::passed ? -normal : normal;
    onward.direction = lambertDirection(onward.side, random);
    return onward;
  }

  BandLanes<N> sent(const glm::vec3& normal, const glm::vec3& /*arriving*/, const glm::vec3& to_light) const {
    const float cosine = glm::dot(normal, to_light);
    BandLanes<N> share = cosine > 0.f ? optics.reflectance : optics.transmittance;
    share *= std::abs(cosine) * std::numbers::inv_pi_v<float>;
    return share;
  }

  float density(const glm::vec3& normal, const glm::vec3& /*arriving*/, const BandLanes<N>& weight,
                const glm::vec3& direction) const {
    const float reflected = dot(weight, optics.reflectance), passed = dot(weight, optics.transmittance);
    if (!(reflected + passed > 0.f)) return 0.f;
    const float cosine = glm::dot(normal, direction);
    return (cosine > 0.f ? reflected : passed) / (reflected + passed) * std::abs(cosine) *
           std::numbers::inv_pi_v<float>;
  }
};

}  // namespace sunfleck::detail
