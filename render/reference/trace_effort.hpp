#pragma once

#include <cstdint>

namespace sunfleck {

// How much is traced. Paths come in units of equal size, whose spread gives the standard errors; a run can end between
// two units.
struct TraceEffort {
  std::uint64_t paths = 1'000'000;  // >= kLeastUnits, rounded up to whole units
  std::uint64_t seed = 1;
  int threads = 0;  // at most; 0: all cores. The result is the same for any number
};

inline constexpr std::uint64_t kLeastUnits = 64;
inline constexpr std::uint64_t kMostUnitPaths = 16'384;

// Throws InvalidInput on a value out of its range.
void validate(const TraceEffort& effort);

// Paths of a unit for a run of so many: the largest power of two, which fills the square of the Sobol' sequence evenly,
// that makes kLeastUnits of them, at most kMostUnitPaths.
std::uint64_t pathsPerUnit(std::uint64_t paths);
// Units that so many paths make.
inline std::uint64_t unitsOf(std::uint64_t paths, std::uint64_t paths_per_unit) {
  return (paths + paths_per_unit - 1) / paths_per_unit;
}

}  // namespace sunfleck
