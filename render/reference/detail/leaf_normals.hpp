#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <numbers>
#include <vector>

#include "render/reference/detail/cosine_law.hpp"
#include "render/reference/trace_medium.hpp"

namespace sunfleck::detail {

// (R15) A of S = A A^T, lower triangular: leaves are turned as the surface of the ellipsoid is that a unit sphere of
// area 4 becomes when its vector areas p are mapped to A p. No S is too flat: of parallel leaves A maps all to one
// normal.
struct LeafEllipsoid {
  float xx = 0.f, yx = 0.f, yy = 0.f, zx = 0.f, zy = 0.f, zz = 0.f;

  LeafEllipsoid() = default;
  // Of leaves of this area; what rounding has made negative of S counts as 0.
  LeafEllipsoid(const ProjectedArea& s, float area) {
    const auto root = [](double square) { return square > 0. ? std::sqrt(square) : 0.; };
    const auto share = [](double of, double by, double most) {
      return by > 0. ? std::clamp(of / by, -most, most) : 0.;
    };
    const double a = root(double{s.xx}), b = share(double{s.xy}, a, root(double{s.yy}));
    const double c = share(double{s.xz}, a, root(double{s.zz}));
    const double d = root(double{s.yy} - b * b), e = share(double{s.yz} - b * c, d, root(double{s.zz} - c * c));
    const double f = root(double{s.zz} - c * c - e * e);
    const auto scaled = [area](double value) { return static_cast<float>(double{area} * value); };
    xx = scaled(a), yx = scaled(b), yy = scaled(d), zx = scaled(c), zy = scaled(e), zz = scaled(f);
  }

  // A^T d: its length is the area seen along d.
  glm::vec3 seen(const glm::vec3& d) const { return {xx * d.x + yx * d.y + zx * d.z, yy * d.y + zy * d.z, zz * d.z}; }
  glm::vec3 mapped(const glm::vec3& p) const { return {xx * p.x, yx * p.x + yy * p.y, zx * p.x + zy * p.y + zz * p.z}; }

  // Normal of a leaf that light along d meets: what is seen of the sphere along A^T d is a disc, evenly.
  glm::vec3 normal(const glm::vec3& d, PathRandom& random) const {
    return glm::normalize(mapped(lambertDirection(glm::normalize(seen(d)), random)));
  }
};

// (R15) Leaves at inclinations that are given, turned every way about the vertical.
class LeafRings {
 public:
  LeafRings() = default;
  explicit LeafRings(const std::vector<LeafRing>& rings) {
    float sum = 0.f;
    for (const LeafRing& ring : rings) {
      cosine_.push_back(ring.cosine);
      up_to_.push_back(sum += ring.weight);
    }
    for (std::size_t i = 0; i < projection_.size(); ++i) {
      // Where light along mu, sigma is in the table, mu and sigma in the ratio t : 1 - t.
      const double t = static_cast<double>(i) / kSteps, length = std::hypot(t, 1. - t);
      for (const LeafRing& ring : rings)
        projection_[i] +=
            static_cast<float>(double{ring.weight / sum} * ofRing(ring.cosine, t / length, (1. - t) / length));
    }
  }

  // G: mean |n . d|, to some 1e-6.
  float projection(const glm::vec3& d) const {
    const float mu = std::abs(d.z), sigma = std::hypot(d.x, d.y);
    const float at = static_cast<float>(kSteps) * mu / (mu + sigma);
    const auto low = std::min(static_cast<std::size_t>(at), kSteps - 1);
    const float part = at - static_cast<float>(low);
    return (1.f - part) * projection_[low] + part * projection_[low + 1];
  }

  // Normal of a leaf that light along d meets: any leaf's, taken with the probability |n . d|.
  glm::vec3 normal(const glm::vec3& d, PathRandom& random) const {
    glm::vec3 n;
    for (int tries = 0; tries < kMostTries; ++tries) {
      const float u = random.uniform() * up_to_.back();
      const auto ring =
          std::min(static_cast<std::size_t>(std::upper_bound(up_to_.begin(), up_to_.end(), u) - up_to_.begin()),
                   cosine_.size() - 1);
      const float turn = 2.f * std::numbers::pi_v<float> * random.uniform();
      const float sine = std::sqrt((1.f - cosine_[ring]) * (1.f + cosine_[ring]));
      n = {sine * std::cos(turn), sine * std::sin(turn), cosine_[ring]};
      if (random.uniform() < std::abs(glm::dot(n, d))) break;
    }
    return n;
  }

  // Mean over the azimuth of |c mu + s sigma cos|, for light whose cosine and sine to the vertical are mu and sigma.
  static double ofRing(double cosine, double mu, double sigma) {
    const double a = cosine * mu, b = std::sqrt((1. - cosine) * (1. + cosine)) * sigma;
    if (a >= b) return a;
    return 2. / std::numbers::pi * (a * std::asin(a / b) + std::sqrt((b - a) * (b + a)));
  }

 private:
  static constexpr std::size_t kSteps = 2048;
  // Where next to nothing is seen of the leaves next to no light meets them: 1e-4 of them is lost to this.
  static constexpr int kMostTries = 100'000;

  std::vector<float> cosine_, up_to_;
  std::array<float, kSteps + 1> projection_{};
};

}  // namespace sunfleck::detail
