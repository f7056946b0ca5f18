#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace sunfleck::detail {

// One number per band of light. All bands travel on one path: what tells them apart are these weights.
template <int N>
struct BandLanes {
  static constexpr int kBands = N;
  alignas(N >= 4 ? 16 : 4) std::array<float, N> of_band{};

  static BandLanes all(float value) {
    BandLanes lanes;
    lanes.of_band.fill(value);
    return lanes;
  }
  float operator[](int band) const { return of_band[static_cast<std::size_t>(band)]; }
  float& operator[](int band) { return of_band[static_cast<std::size_t>(band)]; }
  BandLanes& operator*=(const BandLanes& other) {
    for (int band = 0; band < N; ++band) (*this)[band] *= other[band];
    return *this;
  }
  BandLanes& operator*=(float factor) {
    for (int band = 0; band < N; ++band) (*this)[band] *= factor;
    return *this;
  }
  float largest() const {
    float result = of_band[0];
    for (int band = 1; band < N; ++band) result = std::max(result, (*this)[band]);
    return result;
  }
  friend float dot(const BandLanes& a, const BandLanes& b) {
    float result = 0.f;
    for (int band = 0; band < N; ++band) result += a[band] * b[band];
    return result;
  }
};

}  // namespace sunfleck::detail
