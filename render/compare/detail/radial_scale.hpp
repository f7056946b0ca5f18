#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace sunfleck {

// Radiance to a share of a radius or of a range of colours, 0 .. 1, linear from 0 or over whole decades.
struct RadialScale {
  double low = 0., high = 1.;
  bool logarithmic = false;
  std::vector<double> rings;  // round values to label, the last at share 1

  double at(double radiance) const {
    if (!logarithmic) return std::clamp(radiance / high, 0., 1.);
    return radiance > low ? std::min(1., std::log(radiance / low) / std::log(high / low)) : 0.;
  }
};

// A scale that holds radiances up to `largest`. Logarithmic: at most five decades, down to `smallest` (above 0).
inline RadialScale radialScale(double smallest, double largest, bool logarithmic) {
  if (!(largest > 0.) || !std::isfinite(largest)) largest = 1.;
  RadialScale scale{.logarithmic = logarithmic, .rings = {}};
  if (logarithmic) {
    const int decade = static_cast<int>(std::floor(std::log10(largest)));
    const int bottom = smallest > 0. ? static_cast<int>(std::floor(std::log10(smallest))) : decade - 5;
    for (const double factor : {1., 2., 5., 10.})
      if (factor * std::pow(10., decade) >= largest * (1. - 1e-9)) {
        scale.high = factor * std::pow(10., decade);
        break;
      }
    const int lowest = std::min(decade - 1, std::max(bottom, decade - 4));
    scale.low = std::pow(10., lowest);
    for (int ring = lowest + 1; std::pow(10., ring) < scale.high * (1. - 1e-9); ++ring)
      scale.rings.push_back(std::pow(10., ring));
    scale.rings.push_back(scale.high);
    return scale;
  }
  const double power = std::pow(10., std::floor(std::log10(largest / 4.)));
  double step = 10. * power;
  for (const double factor : {1., 2., 2.5, 5.})
    if (factor * power * 4. >= largest * (1. - 1e-9)) {
      step = factor * power;
      break;
    }
  const int count = static_cast<int>(std::ceil(largest / step - 1e-9));
  for (int i = 1; i <= count; ++i) scale.rings.push_back(i * step);
  scale.high = scale.rings.back();
  return scale;
}

}  // namespace sunfleck
