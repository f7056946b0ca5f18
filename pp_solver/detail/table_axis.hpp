#pragma once

#include <cmath>
#include <numbers>
#include <vector>

// (P12) The coordinates of a table's axes, each running over 0 .. 1, and cubic splines over nodes that are equidistant
// in them.
namespace sunfleck::pp::detail {

// v within low .. high; low for NaN, so that what follows may turn it into an index.
template <typename Number>
Number within(Number low, Number v, Number high) {
  return v > low ? (v < high ? v : high) : low;
}

// Thickness w [1] = most ((e^(a x) - 1) / (e^a - 1))^(3/2): nodes cluster where the slab is thin.
class ThicknessAxis {
 public:
  ThicknessAxis() = default;
  explicit ThicknessAxis(double most)
      : most_(most), stretch_(std::fmax(0.5, 3.5 * std::log(most) / std::log(16.))), range_(std::expm1(stretch_)) {}

  double thickness(double x) const { return most_ * std::pow(std::expm1(stretch_ * x) / range_, 1.5); }
  float coordinate(float w) const {
    const float root = std::cbrt(w / static_cast<float>(most_));
    return std::log1p(root * root * static_cast<float>(range_)) / static_cast<float>(stretch_);
  }

 private:
  double most_ = 1., stretch_ = 0.5, range_ = 1.;
};

// Depth z [1] in a slab of thickness w: t = 1/2 + (u(z) - u(w - z)) / (2 u(w)), u(z) = log(1 + b sqrt(z)). Nodes
// cluster at both faces, the more the thicker the slab: light changes within a depth of 1 of them, however thick it is.
class DepthAxis {
 public:
  static constexpr float kStretch = 2.f;  // b

  static float coordinate(float w, float z) {
    if (!(w > 0.f)) return 0.f;
    return 0.5f + 0.5f * (stretched(z) - stretched(w - z)) / stretched(w);
  }
  static double depth(double w, double t);

 private:
  static float stretched(float z) { return std::log1p(kStretch * std::sqrt(z)); }
};

// |cos| of a direction = sin(pi t / 2)^3: nodes cluster where light grazes the faces, and the sine of the direction,
// whose powers the azimuth modes are, is smooth in t at |cos| = 1.
inline double cosineFrom(double t) {
  const double s = std::sin(0.5 * std::numbers::pi * t);
  return s * s * s;
}
inline float cosineCoordinate(float cosine) {
  return 2.f * std::numbers::inv_pi_v<float> * std::asin(std::cbrt(cosine));
}

// Which four coefficients make a spline's value, and their weights.
struct SplineWeights {
  int first;
  float weight[4];

  // t in [0, 1]; nodes >= 4
  SplineWeights(float t, int nodes) {
    const float place = t * static_cast<float>(nodes - 1);
    first = static_cast<int>(within(0.f, place, static_cast<float>(nodes - 2)));
    const float f = within(0.f, place - static_cast<float>(first), 1.f), r = 1.f - f;
    weight[0] = r * r * r / 6.f;
    weight[3] = f * f * f / 6.f;
    weight[1] = 2.f / 3.f - f * f * (1.f - 0.5f * f);
    weight[2] = 2.f / 3.f - r * r * (1.f - 0.5f * r);
  }
};

// Values on `nodes` places of the middle index of [outer][nodes][inner] become the nodes + 2 coefficients of the cubic
// spline through them, [outer][nodes + 2][inner]; its third derivative has no jump at the nodes next to the ends.
std::vector<double> splineCoefficients(const std::vector<double>& values, std::size_t outer, int nodes,
                                       std::size_t inner);

}  // namespace sunfleck::pp::detail
