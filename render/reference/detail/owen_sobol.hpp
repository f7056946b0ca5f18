#pragma once

#include <array>
#include <cstdint>
#include <utility>

namespace sunfleck::detail {

inline std::uint32_t reversedBits(std::uint32_t x) {
  x = __builtin_bswap32(x);
  x = (x & 0x0f0f0f0fu) << 4 | (x & 0xf0f0f0f0u) >> 4;
  x = (x & 0x33333333u) << 2 | (x & 0xccccccccu) >> 2;
  return (x & 0x55555555u) << 1 | (x & 0xaaaaaaaau) >> 1;
}

// Owen's scrambling of binary digits, the first of which is the lowest bit, by a hash in which every bit depends on the
// bits before it alone (Laine & Karras 2011; the constants of N. Vegdahl 2021).
inline std::uint32_t owenScrambled(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  return x ^ x * 0x53a22864u;
}

// Second dimension of the Sobol' sequence, as a binary fraction, from the first, which is the reversed index: digit i
// is the sum of the digits j whose binomial coefficient over i is odd, those with all of the bits of i (Lucas 1878).
inline std::uint32_t secondSobol(std::uint32_t first) {
  first ^= first << 1 & 0xaaaaaaaau;
  first ^= first << 2 & 0xccccccccu;
  first ^= first << 4 & 0xf0f0f0f0u;
  first ^= first << 8 & 0xff00ff00u;
  return first ^ first << 16;
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
  // Of the reversed index in a shuffled order.
  const std::uint32_t first = owenScrambled(reversedBits(index), seed(0));
  return {reversedBits(owenScrambled(reversedBits(first), seed(1))),
          reversedBits(owenScrambled(reversedBits(secondSobol(first)), seed(2)))};
}

}  // namespace sunfleck::detail
