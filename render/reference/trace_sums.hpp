#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "render/reference/unit_ranges.hpp"
#include "render/reference/unit_tally.hpp"

namespace sunfleck {

// A mean and its standard error, from the spread of independent units. Where there is one unit alone, nothing is known
// of the spread: the standard error is then the value itself.
struct Estimate {
  double value = 0., standard_error = 0.;
};

// A whole number of 2^-64, in 128 bits: sums of any number of units in any order are the same to the last bit, so that
// no split over threads, machines and interruptions shows. Holds values below 2^63.
struct ExactSum {
  __extension__ using Whole = __int128;
  Whole whole = 0;

  // Throws std::overflow_error unless |value| < 2^40.
  void add(double value);
  double value() const;
};

// All that a run has found: which units of which seeds are in it, and per bin the sum of what the units found and of
// its squares.
class TraceSums {
 public:
  // Unit u adds to the bins of group u % groups alone; a bin's mean is over the units of its group.
  TraceSums(std::size_t bins, std::uint64_t groups) : bins_(bins), groups_(groups) {}

  void add(std::uint64_t seed, std::uint64_t unit, const UnitTally& tally);
  // Adds the units of another run of the same kind. Throws std::logic_error when they share one.
  void add(const TraceSums& other);

  Estimate estimate(std::size_t bin, std::uint64_t group = 0) const;
  std::uint64_t units(std::uint64_t group) const;  // of all seeds
  std::uint64_t units() const;
  const UnitRanges& done(std::uint64_t seed) const;
  const std::map<std::uint64_t, UnitRanges>& done() const { return done_; }
  std::size_t bins() const { return bins_.size(); }
  std::uint64_t groups() const { return groups_; }

  struct Bin {
    ExactSum sum, squares;
  };
  const Bin& bin(std::size_t i) const { return bins_[i]; }
  std::span<Bin> values() { return bins_; }
  // What a file held.
  void restore(std::size_t bin, const Bin& value) { bins_[bin] = value; }
  void restore(std::uint64_t seed, UnitRanges done) { done_[seed] = std::move(done); }

 private:
  std::vector<Bin> bins_;
  std::uint64_t groups_;
  std::map<std::uint64_t, UnitRanges> done_;  // by seed
};

}  // namespace sunfleck
