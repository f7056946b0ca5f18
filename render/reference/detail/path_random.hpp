#pragma once

#include <Random123/philox.h>

#include <array>
#include <cstdint>

#include "render/reference/detail/owen_sobol.hpp"

namespace sunfleck::detail {

// Two numbers in [0, 1).
struct Pair {
  float u = 0.f, v = 0.f;
};

// What random numbers are for: those of jobs of different kinds are independent also where their seeds are the same.
enum class Stream : std::uint32_t { light, picture, reflectance, slab, light_picture };

// A set of paths whose first random numbers are points of one Owen-scrambled Sobol' sequence: together they fill the
// square more evenly than chance does. Sets of other numbers are scrambled independently.
struct EvenSet {
  EvenSet(Stream of_stream, std::uint64_t of_seed, std::uint64_t number) : stream(of_stream), seed(of_seed) {
    const auto random = r123::Philox4x32()(
        {{static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(number >> 32), 0, counterOf(stream) + 1}},
        {{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}});
    scramble = {random[0], random[1], random[2]};
  }
  // The last word of the counter: even for paths, odd for sets.
  static std::uint32_t counterOf(Stream stream) { return 2 * static_cast<std::uint32_t>(stream); }

  Stream stream;
  std::uint64_t seed;
  std::array<std::uint32_t, 3> scramble;
};

// The random numbers of one path, made by counting (Philox 4x32-10 of Salmon et al. 2011): they follow from the seed,
// the path's number and how many were taken before, so that any thread, machine or later run can trace the path and
// gets the same.
class PathRandom {
 public:
  // `path`: its number among all of the seed; it is the `index`-th of `set`.
  PathRandom(const EvenSet& set, std::uint64_t path, std::uint32_t index)
      : PathRandom(set.stream, set.seed, path, set.scramble, index, 0) {}
  // A path on its own.
  PathRandom(Stream stream, std::uint64_t seed, std::uint64_t path)
      : PathRandom(stream, seed, path, {}, 0, kEvenPairs) {}

  std::uint32_t bits() {
    if (taken_ == 4) {
      block_ = r123::Philox4x32()(counter_, key_);
      ++counter_[2];
      taken_ = 0;
    }
    return block_[taken_++];
  }
  float uniform() { return static_cast<float>(bits() >> 8) * 0x1p-24f; }  // [0, 1)
  double uniformDouble() {                                                // [0, 1)
    const std::uint64_t high = bits();
    return static_cast<double>((high << 32 | bits()) >> 11) * 0x1p-53;
  }

  // The path's next pair: of the Sobol' sequence as long as evenness pays, that is for where a path starts and its
  // first scatterings.
  Pair pair() {
    if (even_pairs_ == kEvenPairs) {
      const float u = uniform();
      return {u, uniform()};
    }
    const std::uint32_t dimension = even_pairs_++;
    const auto [u, v] = scrambledSobol(index_, scramble_, dimension);
    return {static_cast<float>(u >> 8) * 0x1p-24f, static_cast<float>(v >> 8) * 0x1p-24f};
  }

 private:
  static constexpr std::uint32_t kEvenPairs = 3;

  PathRandom(Stream stream, std::uint64_t seed, std::uint64_t path, const std::array<std::uint32_t, 3>& scramble,
             std::uint32_t index, std::uint32_t even_pairs)
      : key_{{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}},
        counter_{
            {static_cast<std::uint32_t>(path), static_cast<std::uint32_t>(path >> 32), 0, EvenSet::counterOf(stream)}},
        index_(index),
        scramble_(scramble),
        even_pairs_(even_pairs) {}

  r123::Philox4x32::key_type key_;
  r123::Philox4x32::ctr_type counter_, block_;
  unsigned taken_ = 4;
  std::uint32_t index_;
  std::array<std::uint32_t, 3> scramble_;
  std::uint32_t even_pairs_;  // taken
};

}  // namespace sunfleck::detail
