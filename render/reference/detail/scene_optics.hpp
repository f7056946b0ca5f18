#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <variant>
#include <vector>

#include "render/reference/detail/cosine_law.hpp"
#include "render/reference/detail/medium_optics.hpp"
#include "render/reference/detail/scattering.hpp"
#include "render/reference/detail/scene_geometry.hpp"
#include "render/reference/trace_light.hpp"

namespace sunfleck::detail {

// Optics of all that a ray can meet; bands beyond those given are black.
template <int N>
class SceneOptics {
 public:
  SceneOptics(const std::vector<TraceLight>& bands, const RayScene::Geometry& scene)
      : of_kinds_(scene.prototypes.size()), media_(bands, scene) {
    const std::size_t kinds = of_kinds_.size();
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
    if (hit.surface == Surface::leaf) return of_kinds_[hit.kind].leaf;
    return hit.surface == Surface::wood ? of_kinds_[hit.kind].wood : media_.of(hit);
  }
  const SurfaceOptics<N>& ground() const { return ground_; }

  // What becomes of a path that met `hit`: where it goes on to, and with what weight.
  Onward scatter(const Hit& hit, BandLanes<N>& weight, PathRandom& random) const {
    if (hit.surface == Surface::particle) return media_.scatter(hit, weight, random);
    Onward onward{.fate = detail::scatter(of(hit), weight, random)};
    if (onward.fate == Fate::absorbed) return onward;
    onward.side = onward.fate == Fate::passed ? -hit.normal : hit.normal;
    onward.direction = lambertDirection(onward.side, random);
    return onward;
  }

  // The share of the light from the unit vector `to_light` that is sent back along a line of sight that met `hit`, per
  // solid angle and for irradiance 1 on a plane that faces the light: BRDF or BTDF times the light's cosine [1/sr].
  BandLanes<N> sent(const Hit& hit, const glm::vec3& to_light) const {
    if (hit.surface == Surface::particle) return media_.sent(hit, to_light);
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
  MediumOptics<N> media_;
  SurfaceOptics<N> ground_;
};

// The same for any number of bands, in as many lanes as it needs.
class AnyLanes {
 public:
  AnyLanes(const std::vector<TraceLight>& bands, const RayScene::Geometry& scene) : optics_(make(bands, scene)) {}

  template <typename Body>
  void visit(const Body& body) const {
    std::visit(body, optics_);
  }

 private:
  using Optics = std::variant<SceneOptics<1>, SceneOptics<4>, SceneOptics<8>, SceneOptics<16>>;
  static Optics make(const std::vector<TraceLight>& bands, const RayScene::Geometry& scene) {
    if (bands.size() == 1) return SceneOptics<1>(bands, scene);
    if (bands.size() <= 4) return SceneOptics<4>(bands, scene);
    if (bands.size() <= 8) return SceneOptics<8>(bands, scene);
    return SceneOptics<16>(bands, scene);
  }
  Optics optics_;
};

}  // namespace sunfleck::detail
