#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "render/reference/detail/henyey_greenstein.hpp"
#include "render/reference/detail/scattering.hpp"
#include "render/reference/detail/scene_geometry.hpp"
#include "render/reference/trace_light.hpp"

namespace sunfleck::detail {

// Optics of what is met in the media of a scene.
template <int N>
class MediumOptics {
 public:
  MediumOptics(const std::vector<TraceLight>& bands, const RayScene::Geometry& scene) {
    for (std::size_t i = 0; i < scene.media.size(); ++i) {
      Medium& medium = media_.emplace_back(Medium{.asymmetry = double{scene.media[i].asymmetry()}});
      for (std::size_t b = 0; b < bands.size(); ++b) {
        const int band = static_cast<int>(b);
        const LeafOptics& optics = bands[b].of_media[i];
        const bool leaves = scene.media[i].leaves();
        medium.optics.reflectance[band] = leaves ? optics.reflectance : optics.albedo();
        medium.optics.transmittance[band] = leaves ? optics.transmittance : optics.albedo();
      }
    }
  }

  // Of a particle both are its albedo, as there is no side to which it sends nothing.
  const SurfaceOptics<N>& of(const Hit& hit) const { return media_[hit.kind].optics; }

  // (R16) What becomes of a path that met a particle.
  Onward scatter(const Hit& hit, BandLanes<N>& weight, PathRandom& random) const {
    const Medium& medium = media_[hit.kind];
    Onward onward{.fate = detail::scatter({.reflectance = medium.optics.reflectance}, weight, random)};
    if (onward.fate == Fate::absorbed) return onward;
    const Pair at = random.pair();
    const double cosine = sampledCosine(medium.asymmetry, 2. * double{at.u} - 1.);
    const float sine = static_cast<float>(std::sqrt((1. - cosine) * (1. + cosine)));
    const float turn = 2.f * std::numbers::pi_v<float> * at.v;
    const Axes axes = axesAlong(-hit.normal);
    onward.direction = glm::normalize(sine * std::cos(turn) * axes.right + sine * std::sin(turn) * axes.up +
                                      static_cast<float>(cosine) * axes.along);
    return onward;
  }

  // (R16) The share of the light from `to_light` that a particle sends back along a line of sight [1/sr].
  BandLanes<N> sent(const Hit& hit, const glm::vec3& to_light) const {
    BandLanes<N> share = media_[hit.kind].optics.reflectance;
    share *= density(hit, to_light);
    return share;
  }

  // Density of the directions that `scatter` draws [1/sr].
  float density(const Hit& hit, const glm::vec3& direction) const {
    return static_cast<float>(henyeyGreenstein(media_[hit.kind].asymmetry, -double{glm::dot(direction, hit.normal)}));
  }

 private:
  struct Medium {
    double asymmetry = 0.;
    SurfaceOptics<N> optics{};
  };
  std::vector<Medium> media_;
};

}  // namespace sunfleck::detail
