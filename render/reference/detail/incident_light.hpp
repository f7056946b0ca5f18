#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include "render/reference/detail/scene_light.hpp"
#include "render/reference/detail/sunlit_faces.hpp"

namespace sunfleck::detail {

// Where a path of light enters the traced box.
template <int N>
struct Entry {
  glm::vec3 from{0.f};
  Direction direction{0.f, 0.f, -1.f};
  BandLanes<N> weight;  // 1 on the mean over paths, in each band
};

// (R19) The light of sun and sky that enters the traced box, and paths of it spread by flux. Light through the faces
// across one axis goes by its |direction[axis]|, wherever on a face; so a path draws the axis by the flux, the
// direction by that density, and the point evenly, and needs no weight but for bands that it is not drawn for alone.
class IncidentLight {
 public:
  IncidentLight(const RayScene::Geometry& scene, const std::vector<TraceLight>& bands)
      : scene_(scene),
        bands_(bands.size()),
        sun_(bands.front().sun),
        point_(scene, sun_),
        size_(glm::max(scene.box.size(), glm::vec3(scene.lift))),
        sky_(bands.front().sky) {
    if (bands.front().sun_diameter > 0.f) disc_.emplace(-sun_, bands.front().sun_diameter);
    std::array<double, 3> through_sun{};  // for sun irradiance 1 [m^2]
    std::array<glm::dvec3, 3> through_sky{};
    for (int axis = scene.period ? 2 : 0; axis < 3; ++axis) {
      if (disc_) through_sun[at(axis)] = area(axis) * meanThrough(axis);
      if (sky_) through_sky[at(axis)] = area(axis) * integral(*sky_, measureOf(axis));
    }
    const double sun_flux = disc_ ? through_sun[0] + through_sun[1] + through_sun[2] : point_.flux();
    const glm::dvec3 sky_flux = through_sky[0] + through_sky[1] + through_sky[2];

    double sun_weight = 0.;  // means over the bands of what each has per flux of its own
    glm::dvec3 sky_weights(0.);
    for (std::size_t band = 0; band < bands_; ++band) {
      sky_band_[band] = bands[band].sky_band;
      const double sun = double{bands[band].sun_irradiance};
      const double of_sky = sky_ ? sky_flux[sky_band_[band]] : 0.;
      flux_[band] = sun * sun_flux + of_sky;
      sky_share_[band] = of_sky / flux_[band];
      sun_per_flux_[band] = static_cast<float>(sun / flux_[band]);
      inverse_flux_[band] = static_cast<float>(1. / flux_[band]);
      sun_weight += sun / flux_[band] / static_cast<double>(bands_);
      sky_weights[sky_band_[band]] += 1. / flux_[band] / static_cast<double>(bands_);
    }
    if (sun_weight > 0. && !disc_) add({.share = sun_weight * sun_flux, .kind = Kind::point});
    for (int axis = 0; axis < 3; ++axis)
      if (const double flux = through_sun[at(axis)]; sun_weight > 0. && flux > 0.)
        add({.share = sun_weight * flux, .kind = Kind::disc, .axis = axis});
    for (int axis = scene.period ? 2 : 0; sky_ && axis < 3; ++axis) {
      samplers_[at(axis)].emplace(*sky_, sky_weights, measureOf(axis));
      const double flux = samplers_[at(axis)]->total() * area(axis);
      if (flux > 0.) add({.share = flux, .kind = Kind::sky, .axis = axis});
    }
    point_alone_ = sources_.size() == 1 && sources_.front().kind == Kind::point;
  }

  double flux(int band) const { return flux_[at(band)]; }           // in all [m^2]
  double skyShare(int band) const { return sky_share_[at(band)]; }  // of it [1]
  bool sameInAllBands() const { return bands_ == 1 || !sky_; }      // all paths weigh 1

  template <int N>
  Entry<N> enter(PathRandom& random) const {
    Pair start = random.pair();
    if (point_alone_)
      return {
          .from = point_.start(double{start.u}, double{start.v}), .direction = sun_, .weight = BandLanes<N>::all(1.f)};
    double share = double{start.u};
    const Source* source = sources_.data();
    while (source != &sources_.back() && share >= source->share) share -= source++->share;
    const double along = std::clamp(share / source->share, 0., 1. - 0x1p-24);
    if (source->kind == Kind::point)
      return {.from = point_.start(along, double{start.v}), .direction = sun_, .weight = sunWeight<N>()};
    Entry<N> entry;
    if (source->kind == Kind::disc) {
      entry.direction = -discThrough(source->axis, random);
      entry.weight = sunWeight<N>();
    } else {
      const auto [u, v] = random.pair();
      const SkySample sample = samplers_[at(source->axis)]->sample(u, v);
      entry.direction = -sample.to_sky;
      entry.weight = skyWeight<N>(sky_->radiance(sample.cell));
    }
    entry.from = onFace(source->axis, entry.direction, static_cast<float>(along), start.v);
    return entry;
  }

 private:
  enum class Kind { point, disc, sky };
  struct Source {
    double share = 0.;  // of the paths
    Kind kind = Kind::point;
    int axis = 2;
  };
  static std::size_t at(int index) { return static_cast<std::size_t>(index); }
  static SkyMeasure measureOf(int axis) {
    return axis == 0 ? SkyMeasure::through_x : axis == 1 ? SkyMeasure::through_y : SkyMeasure::through_z;
  }
  void add(const Source& source) { sources_.push_back(source); }
  double area(int axis) const { return double{size_[(axis + 1) % 3]} * double{size_[(axis + 2) % 3]}; }

  // Of the disc's directions d, the integral of |d[axis]| over the solid angle times the radiance: |sun[axis]| but
  // where the disc reaches over the plane. With n and t its middle's parts along the axis and across, d[axis] is n cos
  // + t sin cos(turn) at an angle from the middle; over the turn that has a closed form, over the angle goes the
  // midpoint rule.
  double meanThrough(int axis) const {
    constexpr int kSteps = 4096;
    const double n = std::abs(double{sun_[axis]}), t = std::sqrt(std::max(0., 1. - n * n)),
                 reach = double{disc_->sine()};
    if (t * reach <= n * std::sqrt(1. - reach * reach)) return n;
    double sum = 0.;
    for (int i = 0; i < kSteps; ++i) {
      const double sine = (i + 0.5) / kSteps * reach, cosine = std::sqrt(1. - sine * sine);
      const double a = n * cosine, b = t * sine;
      double turn = 2. * std::numbers::pi * a;
      if (b > a) {
        const double zero = std::acos(-a / b);
        turn = 2. * (a * (2. * zero - std::numbers::pi) + 2. * b * std::sin(zero));
      }
      sum += turn * sine / cosine;  // d(solid angle) = sin d(angle) = sin / cos d(sin)
    }
    return sum * reach / kSteps / (std::numbers::pi * reach * reach);
  }

  // A direction to the disc with a density as |d[axis]|.
  glm::vec3 discThrough(int axis, PathRandom& random) const {
    const float n = std::abs(sun_[axis]), t = std::sqrt(std::max(0.f, 1.f - n * n)), reach = disc_->sine();
    const float middle = std::sqrt(1.f - reach * reach);  // cosine of the radius
    const float largest = n >= middle ? 1.f : n * middle + t * reach;
    for (;;) {
      const glm::vec3 direction = disc_->draw(random.pair());
      if (random.uniform() * largest <= std::abs(direction[axis])) return direction;
    }
  }

  // A point on the face across the axis that light of this direction comes to, or a little outside, so that the light
  // meets what lies on the face itself.
  glm::vec3 onFace(int axis, const Direction& direction, float u, float v) const {
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    glm::vec3 point = scene_.box.low;
    point[axis] = direction[axis] < 0.f ? scene_.box.high[axis] : scene_.box.low[axis];
    point[a] += u * size_[a];
    point[b] += v * size_[b];
    if (scene_.period)
      point.z = scene_.high;
    else
      point -= 8.f * scene_.lift * direction;
    return point;
  }

  // By how much a band's share of the light drawn is above the mean of all bands.
  template <int N>
  BandLanes<N> overMean(const std::array<float, kMostBands>& of_bands) const {
    float sum = 0.f;
    for (std::size_t band = 0; band < bands_; ++band) sum += of_bands[band];
    BandLanes<N> weight;
    for (std::size_t band = 0; band < bands_; ++band)
      weight[static_cast<int>(band)] = of_bands[band] * static_cast<float>(bands_) / sum;
    return weight;
  }
  template <int N>
  BandLanes<N> sunWeight() const {
    return overMean<N>(sun_per_flux_);
  }
  template <int N>
  BandLanes<N> skyWeight(const glm::vec3& radiance) const {
    std::array<float, kMostBands> per_flux{};
    for (std::size_t band = 0; band < bands_; ++band) per_flux[band] = radiance[sky_band_[band]] * inverse_flux_[band];
    return overMean<N>(per_flux);
  }

  const RayScene::Geometry& scene_;
  std::size_t bands_;
  Direction sun_;
  SunlitFaces point_;
  glm::vec3 size_;  // of the box; a flat stand still has an inside [m]
  std::shared_ptr<const SkyMap> sky_;
  std::optional<SunDisc> disc_;
  std::array<std::optional<SkySampler>, 3> samplers_;  // through the faces across x, y and z
  std::vector<Source> sources_;
  bool point_alone_ = false;
  std::array<double, kMostBands> flux_{}, sky_share_{};
  std::array<float, kMostBands> sun_per_flux_{}, inverse_flux_{};
  std::array<int, kMostBands> sky_band_{};
};

}  // namespace sunfleck::detail
