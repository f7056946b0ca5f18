#pragma once

#include <array>
#include <cstdint>
#include <utility>

namespace sunfleck::detail {

inline std::uint32_t reversedBits(std::uint32_t x) {
  x = x << 16 | x >> 16;
  x = (x & 0x00ff00ffu) << 8 | (x & 0xff00ff00u) >> 8;
  x = (x & 0x0f0f0f0fu) << 4 | (x & 0xf0f0f0f0u) >> 4;
  x = (x & 0x33333333u) << 2 | (x & 0xccccccccu) >> 2;
  return (x & 0x55555555u) << 1 | (x & 0xaaaaaaaau) >> 1;
}

// Owen's scrambling of the binary digits of x, first digit first, by a hash in which every bit depends on the bits
// before it alone (Laine & Karras 2011; the constants of N. Vegdahl 2021).
inline std::uint32_t owenScrambled(std::uint32_t x, std::uint32_t seed) {
  x = reversedBits(x);
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return reversedBits(x);
}

// Second dimension of the Sobol' sequence, as a binary fraction; the first is the reversed index.
inline std::uint32_t secondSobol(std::uint32_t index) {
  std::uint32_t result = 0;
  for (std::uint32_t direction = 1u << 31; index != 0; index >>= 1, direction ^= direction >> 1)
    if (index & 1u) result ^= direction;
  return result;
}

// Point `index` of the two first dimensions of the Sobol' sequence, scrambled. Further pairs of dimensions, numbered by
// `dimension`, are the same points in another, independently scrambled order (Burley 2020, "Practical hash-based Owen
// scrambling"): even in each pair, and independent between pairs.
inline std::pair<std::uint32_t, std::uint32_t> scrambledSobol(std::uint32_t index,
                                                              const std::array<std::uint32_t, 3>& seeds,
                                                              std::uint32_t dimension) {
  const auto seed = [&](std::size_t i) {
    std::uint32_t x = seeds[i] ^ dimension * 0x9e3779b9u;
    x = (x ^ x >> 16) * 0x7feb352du;
    x = (x ^ x >> 15) * 0x846ca68bu;
    return x ^ x >> 16;
  };
  const std::uint32_t shuffled = owenScrambled(index, seed(0));
  return {owenScrambled(reversedBits(shuffled), seed(1)), owenScrambled(secondSobol(shuffled), seed(2))};
}

}  // namespace sunfleck::detail
