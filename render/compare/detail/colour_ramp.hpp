#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace sunfleck {

// Viridis by nine of its colours (N. Smith and S. van der Walt 2015, CC0), joined by straight lines: sRGB codes, 0
// .. 1.
inline std::array<double, 3> rampColour(double share) {
  static constexpr std::array<std::array<double, 3>, 9> colours{{{0.267, 0.005, 0.329},
                                                                 {0.279, 0.175, 0.483},
                                                                 {0.230, 0.322, 0.546},
                                                                 {0.173, 0.449, 0.558},
                                                                 {0.128, 0.567, 0.551},
                                                                 {0.158, 0.684, 0.502},
                                                                 {0.369, 0.789, 0.383},
                                                                 {0.678, 0.864, 0.190},
                                                                 {0.993, 0.906, 0.144}}};
  const double place = std::clamp(share, 0., 1.) * (colours.size() - 1);
  const auto left = std::min(static_cast<std::size_t>(place), colours.size() - 2);
  const double along = place - static_cast<double>(left);
  std::array<double, 3> colour{};
  for (std::size_t c = 0; c < 3; ++c) colour[c] = colours[left][c] + along * (colours[left + 1][c] - colours[left][c]);
  return colour;
}

}  // namespace sunfleck
