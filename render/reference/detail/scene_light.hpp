#pragma once

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include "core/directions.hpp"
#include "render/reference/detail/band_lanes.hpp"
#include "render/reference/detail/path_random.hpp"
#include "render/reference/trace_light.hpp"
#include "sky/sky_sampler.hpp"

namespace sunfleck::detail {

// The sun as a disc of even radiance, that gives irradiance 1 to a plane that faces it.
class SunDisc {
 public:
  //   diameter  > 0 [rad]
  SunDisc(const Direction& to_sun, float diameter)
      : to_sun_(to_sun),
        versine_(2.f * std::pow(std::sin(0.25f * diameter), 2.f)),
        radiance_(std::numbers::inv_pi_v<float> / std::pow(std::sin(0.5f * diameter), 2.f)) {}

  float radiance() const { return radiance_; }                                       // [1/sr]
  float density() const { return 0.5f * std::numbers::inv_pi_v<float> / versine_; }  // of draw() [1/sr]
  const Direction& toSun() const { return to_sun_; }                                 // its middle
  float sine() const { return std::sqrt(versine_ * (2.f - versine_)); }              // of its radius
  // |a - b|^2 = 2 (1 - cos): the difference keeps digits that the cosine of a small angle has lost.
  bool covers(const glm::vec3& direction) const {
    const glm::vec3 off = direction - to_sun_;
    return glm::dot(off, off) <= 2.f * versine_;
  }
  // A direction to a point of the disc, evenly spread over its solid angle.
  glm::vec3 draw(const Pair& at) const {
    const float versine = at.u * versine_, sine = std::sqrt(versine * (2.f - versine));
    const float turn = 2.f * std::numbers::pi_v<float> * at.v;
    const Axes axes = axesAlong(to_sun_);
    return sine * std::cos(turn) * axes.right + sine * std::sin(turn) * axes.up + (1.f - versine) * to_sun_;
  }

 private:
  Direction to_sun_;
  float versine_;  // 1 - cosine of the disc's radius
  float radiance_;
};

// Light drawn for a surface.
template <int N>
struct DrawnLight {
  glm::vec3 to_light{0.f};  // unit
  float density = 0.f;      // of the direction [1/sr]
  BandLanes<N> radiance;    // [1/sr]
};

// The sun and the sky of all bands, as paths from the eye find them: the sun as a point is asked for alone, as nothing
// meets it by chance; the wide lights, its disc and the sky, are drawn (R18) as well as met.
class SceneLight {
 public:
  explicit SceneLight(const std::vector<TraceLight>& bands) : bands_(bands.size()), to_sun_(-bands.front().sun) {
    bool shines = false;
    glm::dvec3 weights(0.);  // of the sky's bands, so that all bands count alike, however bright
    sky_ = bands.front().sky;
    for (std::size_t band = 0; band < bands_; ++band) {
      sun_[band] = bands[band].sun_irradiance;
      shines = shines || sun_[band] > 0.f;
      sky_band_[band] = bands[band].sky_band;
      if (!sky_) continue;
      const double irradiance = sky_->irradiance()[sky_band_[band]];
      if (irradiance > 0.) weights[sky_band_[band]] += 1. / irradiance;
    }
    if (sky_) sampler_.emplace(*sky_, weights, SkyMeasure::solid_angle);
    if (sky_ && sampler_->total() == 0.) sky_ = nullptr;
    if (shines && bands.front().sun_diameter > 0.f) disc_.emplace(to_sun_, bands.front().sun_diameter);
    point_sun_ = shines && !disc_;
  }

  bool pointSun() const { return point_sun_; }
  bool wide() const { return disc_ || sky_; }
  const Direction& toSun() const { return to_sun_; }
  template <int N>
  BandLanes<N> sunIrradiance() const {  // of a plane that faces the sun [1]
    BandLanes<N> lanes;
    for (std::size_t band = 0; band < bands_; ++band) lanes[static_cast<int>(band)] = sun_[band];
    return lanes;
  }

  // Draws from each of the wide lights and passes what it drew to `use`.
  template <int N, typename Use>
  void draw(PathRandom& random, const Use& use) const {
    if (sky_) {
      const auto [u, v] = random.pair();
      const SkySample sample = sampler_->sample(u, v);
      use(DrawnLight<N>{sample.to_sky, sample.density, skyRadiance<N>(sky_->radiance(sample.cell))});
    }
    if (disc_) use(DrawnLight<N>{disc_->draw(random.pair()), disc_->density(), discRadiance<N>()});
  }

  // (R18) What a path finds that leaves in a direction that scattering drew with this density [1/sr], by the share of
  // that light that the balance heuristic leaves to it; infinity: all of it.
  template <int N>
  BandLanes<N> met(const glm::vec3& direction, float density) const {
    BandLanes<N> found;
    if (!(density > 0.f)) return found;
    const auto add = [&](BandLanes<N> radiance, float drawn) {
      if (std::isfinite(density)) radiance *= density / (density + drawn);
      for (int band = 0; band < N; ++band) found[band] += radiance[band];
    };
    if (sky_ && direction.z > 0.f) add(skyRadiance<N>(sky_->radiance(direction)), sampler_->density(direction));
    if (disc_ && disc_->covers(direction)) add(discRadiance<N>(), disc_->density());
    return found;
  }

 private:
  template <int N>
  BandLanes<N> skyRadiance(const glm::vec3& of_sky) const {
    BandLanes<N> lanes;
    for (std::size_t band = 0; band < bands_; ++band) lanes[static_cast<int>(band)] = of_sky[sky_band_[band]];
    return lanes;
  }
  template <int N>
  BandLanes<N> discRadiance() const {
    BandLanes<N> lanes = sunIrradiance<N>();
    lanes *= disc_->radiance();
    return lanes;
  }

  std::size_t bands_;
  Direction to_sun_;
  bool point_sun_ = false;
  std::array<float, kMostBands> sun_{};  // irradiance [1]
  std::array<int, kMostBands> sky_band_{};
  std::shared_ptr<const SkyMap> sky_;  // none where it is black
  std::optional<SkySampler> sampler_;
  std::optional<SunDisc> disc_;
};

}  // namespace sunfleck::detail
