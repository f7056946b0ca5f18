#pragma once

#include <cstdint>

#include "spp/slab.hpp"

// Numbers of single precision in the lanes of one vector, which the shared formulas take for a Number. Compiled once
// for each instruction set, in a namespace of its own; holds no code that others share.
namespace sunfleck::spp::SUNFLECK_ISA {

constexpr int kLanes = SUNFLECK_VECTOR_BYTES / sizeof(float);
typedef float Floats __attribute__((vector_size(SUNFLECK_VECTOR_BYTES)));
typedef std::int32_t Integers __attribute__((vector_size(SUNFLECK_VECTOR_BYTES)));

struct Mask {
  Integers of;
};

struct Lanes {
  Floats of;

  Lanes() = default;
  Lanes(Floats lanes) : of(lanes) {}
  Lanes(float all) : of(all - Floats{}) {}

  friend Lanes operator-(Lanes a) { return -a.of; }
  friend Lanes operator+(Lanes a, Lanes b) { return a.of + b.of; }
  friend Lanes operator-(Lanes a, Lanes b) { return a.of - b.of; }
  friend Lanes operator*(Lanes a, Lanes b) { return a.of * b.of; }
  friend Lanes operator/(Lanes a, Lanes b) { return a.of / b.of; }
  Lanes& operator+=(Lanes b) { return *this = *this + b; }
  Lanes& operator-=(Lanes b) { return *this = *this - b; }
  Lanes& operator*=(Lanes b) { return *this = *this * b; }

  friend Mask operator<(Lanes a, Lanes b) { return {a.of < b.of}; }
  friend Mask operator>(Lanes a, Lanes b) { return {a.of > b.of}; }
};

inline Lanes select(Mask where, Lanes a, Lanes b) {
  return where.of ? a.of : b.of;
}
inline Lanes min(Lanes a, Lanes b) {
  return b.of < a.of ? b.of : a.of;
}
inline Lanes max(Lanes a, Lanes b) {
  return a.of < b.of ? b.of : a.of;
}
inline Lanes abs(Lanes a) {
  return (Floats)((Integers)a.of & 0x7fffffff);
}
inline Lanes sqrt(Lanes a) {
  Floats root;
  for (int i = 0; i < kLanes; ++i) root[i] = __builtin_sqrtf(a.of[i]);
  return root;
}

// e^x for x <= 0, -infinity included, to 1 unit in the last place; 0 where it would be below the normal numbers.
[[gnu::always_inline]] inline Lanes exp(Lanes x) {
  constexpr float kLowest = -87.3365f;
  constexpr float kShift = 0x1.8p23f;  // adding it leaves the nearest integer in the low bits
  const Floats y = max(x, kLowest).of;
  const Floats shifted = y * 1.44269504f + kShift;
  const Floats power = shifted - kShift;
  const Floats r = (y - power * 0x1.63p-1f) + power * 2.12194440e-4f;  // ln 2 in two parts (Cody & Waite 1980)
  // Best polynomial for |r| <= ln 2 / 2, of expf in the Cephes library (Moshier 1989).
  Floats p = 1.9875691500e-4f * r + 1.3981999507e-3f;
  p = p * r + 8.3334519073e-3f;
  p = p * r + 4.1665795894e-2f;
  p = p * r + 1.6666665459e-1f;
  p = p * r + 5.0000001201e-1f;
  p = p * (r * r) + r + 1.f;
  const Floats scaled = p * (Floats)(((Integers)shifted + 127) << 23);
  return x.of < kLowest ? Floats{} : scaled;
}

}  // namespace sunfleck::spp::SUNFLECK_ISA

template <>
struct sunfleck::spp::PrecisionOf<sunfleck::spp::SUNFLECK_ISA::Lanes> {
  using Real = float;
};
