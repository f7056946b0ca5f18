#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "render/reference/unit_tally.hpp"

namespace sunfleck {

using Stopped = std::atomic<bool>;

// What tells two runs apart, by name: the program's version, the scene, the sun, the optics, the size of a unit. Sums
// of runs that differ in any of it are never added.
using TraceIdentity = std::map<std::string, std::string>;

// A Monte Carlo estimate cut into units of equal size. A unit's random numbers follow from the seed and its number, so
// that it finds the same whoever computes it, when and beside what.
class TraceJob {
 public:
  virtual ~TraceJob() = default;

  virtual std::size_t bins() const = 0;
  // Unit u adds to the bins of group u % groups alone.
  virtual std::uint64_t groups() const { return 1; }
  virtual TraceIdentity identity() const = 0;
  // Computes a unit into a cleared tally. Called by several threads at once. When `stopped` turns true it returns early
  // and what it found is dropped.
  virtual void trace(std::uint64_t seed, std::uint64_t unit, UnitTally& tally, const Stopped& stopped) const = 0;
};

}  // namespace sunfleck
