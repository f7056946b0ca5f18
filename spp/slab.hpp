#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>

#include "core/quantities.hpp"

// The C++ face of the shared formulas: `spp` in single precision as on the GPU, `spp::precise` in double, and
// StreamFormulas for any kind of number and a number of streams known when it is compiled.
namespace sunfleck::spp {

using std::abs;
using std::exp;
using std::sqrt;

template <typename T>
constexpr T min(T a, T b) {
  return b < a ? b : a;
}
template <typename T>
constexpr T max(T a, T b) {
  return a < b ? b : a;
}
template <typename T>
constexpr T select(bool condition, T a, T b) {
  return condition ? a : b;
}

namespace detail {

// (-1)^n / (n + 1)!, n = 0 .. kDegree: the series of (1 - e^-x) / x.
template <typename Real, int kDegree>
constexpr std::array<Real, kDegree + 1> decaySeries() {
  std::array<Real, kDegree + 1> terms{};
  double term = 1.;
  for (int n = 0; n <= kDegree; ++n) {
    terms[static_cast<std::size_t>(n)] = static_cast<Real>(term);
    term /= -(n + 2.);
  }
  return terms;
}

// Degrees that leave less than half a rounding for |x| < 1/2.
template <typename Real>
inline constexpr int kSeriesDegree = std::is_same_v<Real, float> ? 7 : 13;
template <typename Real>
inline constexpr auto kSeries = decaySeries<Real, kSeriesDegree<Real>>();

}  // namespace detail

#define SHARED_FN inline
#define SHARED_IN(Type) Type
#define SHARED_CONSTANT inline constexpr
inline constexpr const float* kDecaySeries = detail::kSeries<float>.data();
inline constexpr int kSeriesDegree = detail::kSeriesDegree<float>;
#include "spp/spp_formulas.glsl"
// The tables' part is for single numbers alone.
#include "spp/power_table.glsl"

namespace precise {
using Number = double;
inline constexpr const double* kDecaySeries = detail::kSeries<double>.data();
inline constexpr int kSeriesDegree = detail::kSeriesDegree<double>;
#include "spp/spp_formulas.glsl"
}  // namespace precise
#undef SHARED_FN
#undef SHARED_IN
#undef SHARED_CONSTANT

// The precision of a kind of number that is made of others, such as the lanes of a vector.
template <typename Number>
struct PrecisionOf {
  using Real = Number;
};

// All formulas for one kind of number and STREAMS streams in each half.
template <typename Number, int STREAMS = 1>
struct StreamFormulas {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SHARED_FN static inline  // all in one, with the sanitizers' checks between, would compile for minutes
#else
#define SHARED_FN [[gnu::always_inline]] static inline
#endif
#define SHARED_IN(Type) const Type&
  using Real = typename PrecisionOf<Number>::Real;
  static constexpr const Real* kDecaySeries = detail::kSeries<Real>.data();
  static constexpr int kSeriesDegree = detail::kSeriesDegree<Real>;
#include "spp/spp_formulas.glsl"
#include "spp/stream_formulas.glsl"
#undef SHARED_FN
#undef SHARED_IN
};

}  // namespace sunfleck::spp
