#include "scattering/leaf_gloss.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "scattering/detail/gloss_text.hpp"

namespace sunfleck {
namespace {

using namespace gloss;

constexpr double kRootPi = 1. / std::numbers::inv_sqrtpi;

// A slope p with the density e^(-p^2) (c - p s), p < c / s, by inverting its distribution function at u: the slope of a
// visible facet of roughness 1 along the line of sight, whose cosine and sine are c and s.
double visibleSlope(double c, double s, double u) {
  const auto distribution = [&](double p) { return 0.5 * (c * kRootPi * std::erfc(-p) + s * std::exp(-p * p)); };
  double low = -6., high = s * 6. > c ? c / s : 6.;  // beyond lie 1e-16 of the slopes
  const double wanted = u * distribution(high);
  double p = std::min(0., high);
  for (int i = 0; i < 60 && high - low > 1e-7; ++i) {
    const double over = distribution(p) - wanted;
    (over > 0. ? high : low) = p;
    const double step = over / (std::exp(-p * p) * (c - p * s));
    const double next = p - step;
    if (std::abs(step) < 1e-7) return next;
    p = next > low && next < high ? next : 0.5 * (low + high);
  }
  return p;
}

}  // namespace

LeafGloss::LeafGloss(float roughness) : roughness_(roughness) {
  double mean = 0., before = 0.;
  for (std::size_t i = 0; i < albedo_.size(); ++i) {
    const double root = static_cast<double>(i) / kGlossAlbedos, cosine = root * root;
    albedo_[i] = static_cast<float>(integratedAlbedo(cosine));
    if (i > 0)
      mean += (cosine - before) *
              (double{albedo_[i - 1]} * (2. * before + cosine) + double{albedo_[i]} * (before + 2. * cosine)) / 3.;
    before = cosine;
  }
  mean_albedo_ = static_cast<float>(mean);
}

// Over the slopes (p, q) in units of the roughness, along the plane of incidence and across it, where all is symmetric:
// the rule of midpoints, which for a Gaussian is as good as exact.
double LeafGloss::integratedAlbedo(double cosine) const {
  constexpr double kWidest = 4.5, kStep = 1. / 16.;
  const double m = double{roughness_}, sine = std::sqrt((1. - cosine) * (1. + cosine));
  const double seen = double{visible(static_cast<float>(cosine))};
  double sum = 0.;
  for (double p = -kWidest + 0.5 * kStep; p < kWidest; p += kStep)
    for (double q = 0.5 * kStep; q < kWidest; q += kStep) {
      // The facet's normal is (-m p, -m q, 1) over its length; the eye is at (sine, 0, cosine).
      const double facing = cosine - m * p * sine, length_squared = 1. + m * m * (p * p + q * q);
      const double light = 2. * facing / length_squared - cosine;
      if (!(facing > 0. && light > 0.)) continue;
      const double unmasked = seen * light + (double{visible(static_cast<float>(light))} - light) * cosine;
      sum += std::exp(-p * p - q * q) * facing * light / unmasked;
    }
  return 2. * std::numbers::inv_pi * kStep * kStep * sum;
}

float LeafGloss::facets(const glm::vec3& half_way) const {
  return glossFacets(half_way.x * half_way.x + half_way.y * half_way.y, half_way.z, roughness_);
}

float LeafGloss::visible(float cosine) const {
  return glossVisible(cosine, roughness_);
}

float LeafGloss::brdf(const glm::vec3& to_eye, const glm::vec3& to_light) const {
  return glossBrdf(to_eye.z, to_light.z, facets(glm::normalize(to_eye + to_light)), roughness_);
}

float LeafGloss::albedo(float cosine) const {
  const GlossPlace place = glossAlbedoPlace(cosine);
  const auto i = static_cast<std::size_t>(place.node);
  return between(albedo_[i], albedo_[i + 1], place.part);
}

float LeafGloss::density(const glm::vec3& to_eye, const glm::vec3& to_light) const {
  return facets(glm::normalize(to_eye + to_light)) / (4.f * visible(to_eye.z));
}

// Visible normals by their slopes: seen in the plane of the line of sight, and stretched so that the roughness is 1,
// the slope along the line and the one across it are independent (Heitz & d'Eon 2014).
LeafGloss::Sample LeafGloss::sample(const glm::vec3& to_eye, float u, float v) const {
  const double across = std::hypot(double{to_eye.x}, double{to_eye.y}), stretched = double{roughness_} * across;
  const double length = std::hypot(stretched, double{to_eye.z});
  const double x = across > 0. ? double{to_eye.x} / across : 1., y = across > 0. ? double{to_eye.y} / across : 0.;
  const double along = double{roughness_} * visibleSlope(double{to_eye.z} / length, stretched / length, double{u});
  const double aside = double{roughness_} * visibleSlope(1., 0., double{v});
  const glm::vec3 half_way = glm::vec3(glm::normalize(glm::dvec3(-along * x + aside * y, -along * y - aside * x, 1.)));
  const glm::vec3 to_light = glm::normalize(2.f * glm::dot(to_eye, half_way) * half_way - to_eye);
  if (!(to_light.z > 0.f)) return {};
  const float seen = visible(to_eye.z) * to_light.z;
  return {to_light, seen / (seen + (visible(to_light.z) - to_light.z) * to_eye.z)};
}

}  // namespace sunfleck
