#pragma once

#include <bit>
#include <cstdint>

namespace sunfleck {

// xoshiro256++ of Blackman & Vigna 2019, seeded by splitmix64: a stream for every (seed, stream) pair, the same on any
// machine and for any number of threads.
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t stream) {
    std::uint64_t x = seed * 0x9E3779B97F4A7C15u ^ (stream + 1u) * 0xD1B54A32D192ED03u;
    for (std::uint64_t& word : state_) word = splitmix(x);
  }

  std::uint64_t bits() {
    const std::uint64_t result = std::rotl(state_[0] + state_[3], 23) + state_[0];
    const std::uint64_t shifted = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= shifted;
    state_[3] = std::rotl(state_[3], 45);
    return result;
  }

  float uniform() { return static_cast<float>(bits() >> 40) * 0x1p-24f; }         // [0, 1)
  double uniformDouble() { return static_cast<double>(bits() >> 11) * 0x1p-53; }  // [0, 1)

 private:
  static std::uint64_t splitmix(std::uint64_t& x) {
    std::uint64_t z = (x += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }

  std::uint64_t state_[4];
};

}  // namespace sunfleck
