#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <variant>
#include <vector>

#include "render/reference/detail/cosine_law.hpp"
#include "render/reference/detail/scattering.hpp"
#include "render/reference/detail/scene_geometry.hpp"
#include "render/reference/trace_light.hpp"

namespace sunfleck::detail {

// Optics of all that a ray can meet; bands beyond those given are black.
template <int N>
class SceneOptics {
 public:
  SceneOptics(const std::vector<TraceLight>& bands, std::size_t kinds) : of_kinds_(kinds) {
    for (std::size_t b = 0; b < bands.size(); ++b) {
      const int band = static_cast<int>(b);
      ground_.reflectance[band] = bands[b].ground_albedo;
      for (std::size_t kind = 0; kind < kinds; ++kind) {
        const TreeOptics tree = bands[b].ofKind(static_cast<std::uint32_t>(kind));
        of_kinds_[kind].leaf.reflectance[band] = tree.leaf.reflectance;
        of_kinds_[kind].leaf.transmittance[band] = tree.leaf.transmittance;
        of_kinds_[kind].wood.reflectance[band] = tree.wood_reflectance;
      }
    }
  }

  // Of what was hit, nothing being the ground.
  const SurfaceOptics<N>& of(const Hit& hit) const {
    if (hit.surface == Surface::none) return ground_;
    return hit.surface == Surface::leaf ? of_kinds_[hit.kind].leaf : of_kinds_[hit.kind].wood;
  }
  const SurfaceOptics<N>& ground() const { return ground_; }

  // What becomes of a path that met `hit`: where it goes on to, and with what weight.
  Onward scatter(const Hit& hit, BandLanes<N>& weight, PathRandom& random) const {
    Onward onward{.fate = detail::scatter(of(hit), weight, random)};
    if (onward.fate == Fate::absorbed) return onward;
    onward.side = onward.fate == Fate::passed ? -hit.normal : hit.normal;
    onward.direction = lambertDirection(onward.side, random);
    return onward;
  }

  // The density [1/sr] of the direction, a unit vector, in which scatter() sends on a path that arrives with `weight`.
  // Whoever changes the directions of one changes both, as multiple importance sampling (R18) rests on it.
  float density(const Hit& hit, const BandLanes<N>& weight, const glm::vec3& direction) const {
    const float cosine = glm::dot(hit.normal, direction);
    const SurfaceOptics<N>& surface = of(hit);
    const float reflected = dot(weight, surface.reflectance), passed = dot(weight, surface.transmittance);
    const float on_side = cosine > 0.f ? reflected : passed;
    return on_side > 0.f ? on_side / (reflected + passed) * std::abs(cosine) * std::numbers::inv_pi_v<float> : 0.f;
  }

  // The share of the light from the unit vector `to_light` that is sent back along a line of sight that met `hit`, per
  // solid angle and for irradiance 1 on a plane that faces the light: BRDF or BTDF times the light's cosine [1/sr].
  BandLanes<N> sent(const Hit& hit, const glm::vec3& to_light) const {
    const float cosine = glm::dot(hit.normal, to_light);
    BandLanes<N> share = cosine > 0.f ? of(hit).reflectance : of(hit).transmittance;
    share *= std::abs(cosine) * std::numbers::inv_pi_v<float>;
    return share;
  }

 private:
  struct Kind {
    SurfaceOptics<N> leaf, wood;
  };
  std::vector<Kind> of_kinds_;
  SurfaceOptics<N> ground_;
};

// The same for any number of bands, in as many lanes as it needs.
class AnyLanes {
 public:
  AnyLanes(const std::vector<TraceLight>& bands, std::size_t kinds) : optics_(make(bands, kinds)) {}

  template <typename Body>
  void visit(const Body& body) const {
    std::visit(body, optics_);
  }

 private:
  using Optics = std::variant<SceneOptics<1>, SceneOptics<4>, SceneOptics<8>, SceneOptics<16>>;
  static Optics make(const std::vector<TraceLight>& bands, std::size_t kinds) {
    if (bands.size() == 1) return SceneOptics<1>(bands, kinds);
    if (bands.size() <= 4) return SceneOptics<4>(bands, kinds);
    if (bands.size() <= 8) return SceneOptics<8>(bands, kinds);
    return SceneOptics<16>(bands, kinds);
  }
  Optics optics_;
};

}  // namespace sunfleck::detail
