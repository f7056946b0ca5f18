#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <variant>
#include <vector>

#include "render/reference/detail/ground_surface.hpp"
#include "render/reference/detail/lambert_surface.hpp"
#include "render/reference/detail/leaf_surface.hpp"
#include "render/reference/detail/medium_optics.hpp"
#include "render/reference/detail/scattering.hpp"
#include "render/reference/detail/scene_geometry.hpp"
#include "render/reference/trace_light.hpp"

namespace sunfleck::detail {

// Optics of all that a ray can meet; bands beyond those given are black.
template <int N>
class SceneOptics {
 public:
  // `scene` must outlive it.
  SceneOptics(const std::vector<TraceLight>& bands, const RayScene::Geometry& scene)
      : of_kinds_(scene.prototypes.size()),
        media_(bands, scene),
        ground_beyond_lambert_(GroundSurface<N>::of(bands, scene)) {
    const std::size_t kinds = of_kinds_.size();
    for (std::size_t b = 0; b < bands.size(); ++b) {
      const int band = static_cast<int>(b);
      ground_.reflectance[band] = bands[b].largestGroundAlbedo();
      for (std::size_t kind = 0; kind < kinds; ++kind) {
        const TreeOptics tree = bands[b].ofKind(static_cast<std::uint32_t>(kind));
        of_kinds_[kind].leaf.reflectance[band] = tree.leaf.reflectance;
        of_kinds_[kind].leaf.transmittance[band] = tree.leaf.transmittance;
        of_kinds_[kind].wood.reflectance[band] = tree.wood_reflectance;
      }
    }
    for (std::size_t kind = 0; kind < kinds; ++kind) {
      std::optional<LeafSurface<N>>& beyond_lambert = of_kinds_[kind].beyond_lambert;
      beyond_lambert = LeafSurface<N>::of(bands, static_cast<std::uint32_t>(kind), scene);
      if (beyond_lambert) of_kinds_[kind].leaf = beyond_lambert->bounds();
    }
    lambert_ = !ground_beyond_lambert_ && !scene.hasParticles() &&
               std::ranges::none_of(of_kinds_, [](const Kind& kind) { return kind.beyond_lambert.has_value(); });
  }

  // Of what was hit, nothing being the ground. Of leaves with a gloss or maps and of ground not alike everywhere or in
  // all directions it tells no more than this: where it is 0, nothing is sent.
  const SurfaceOptics<N>& of(const Hit& hit) const {
    if (hit.surface == Surface::none) return ground_;
    if (hit.surface == Surface::leaf) return of_kinds_[hit.kind].leaf;
    return hit.surface == Surface::wood ? of_kinds_[hit.kind].wood : media_.of(hit);
  }
  const SurfaceOptics<N>& ground() const { return ground_; }

  // What becomes of a path that met `hit`, travelling along `arriving`: where it goes on to, and with what weight.
  Onward scatter(const Hit& hit, const glm::vec3& arriving, BandLanes<N>& weight, PathRandom& random) const {
    if (!lambert_) [[unlikely]] {
      if (const LeafSurface<N>* leaf = leafBeyondLambert(hit)) return leaf->scatter(hit, arriving, weight, random);
      if (isGroundBeyondLambert(hit)) return ground_beyond_lambert_->scatter(hit, arriving, weight, random);
      if (hit.surface == Surface::particle) return media_.scatter(hit, weight, random);
    }
    return LambertSurface<N>{of(hit)}.scatter(hit.normal, arriving, weight, random);
  }

  // The share of the light from the unit vector `to_light` that is sent back along a line of sight that met `hit`,
  // running along `arriving`, per solid angle and for irradiance 1 on a plane that faces the light: BRDF or BTDF times
  // the light's cosine [1/sr].
  BandLanes<N> sent(const Hit& hit, const glm::vec3& arriving, const glm::vec3& to_light) const {
    if (!lambert_) [[unlikely]] {
      if (const LeafSurface<N>* leaf = leafBeyondLambert(hit)) return leaf->sent(hit, arriving, to_light);
      if (isGroundBeyondLambert(hit)) return ground_beyond_lambert_->sent(hit, arriving, to_light);
      if (hit.surface == Surface::particle) return media_.sent(hit, to_light);
    }
    return LambertSurface<N>{of(hit)}.sent(hit.normal, arriving, to_light);
  }

  // Density of the directions that `scatter` draws for a path that arrives with this weight [1/sr]. Whoever changes the
  // directions of one changes both, as multiple importance sampling (R18) rests on it.
  float density(const Hit& hit, const glm::vec3& arriving, const BandLanes<N>& weight,
                const glm::vec3& direction) const {
    if (!lambert_) [[unlikely]] {
      if (const LeafSurface<N>* leaf = leafBeyondLambert(hit)) return leaf->density(hit, arriving, weight, direction);
      if (isGroundBeyondLambert(hit)) return ground_beyond_lambert_->density(direction);
      if (hit.surface == Surface::particle) return media_.density(hit, direction);
    }
    return LambertSurface<N>{of(hit)}.density(hit.normal, arriving, weight, direction);
  }

 private:
  struct Kind {
    SurfaceOptics<N> leaf, wood;  // leaf: where it is beyond Lambert's law, what LeafSurface::bounds says
    std::optional<LeafSurface<N>> beyond_lambert;
  };
  const LeafSurface<N>* leafBeyondLambert(const Hit& hit) const {
    if (hit.surface != Surface::leaf) return nullptr;
    const std::optional<LeafSurface<N>>& leaf = of_kinds_[hit.kind].beyond_lambert;
    return leaf ? &*leaf : nullptr;
  }
  bool isGroundBeyondLambert(const Hit& hit) const {
    return hit.surface == Surface::none && ground_beyond_lambert_.has_value();
  }

  std::vector<Kind> of_kinds_;
  SurfaceOptics<N> ground_;
  MediumOptics<N> media_;
  std::optional<GroundSurface<N>> ground_beyond_lambert_;
  bool lambert_ = true;  // whether all scatter by Lambert's law, everywhere alike
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
