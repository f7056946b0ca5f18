#include "render/reference/trace_effort.hpp"

#include <algorithm>
#include <bit>
#include <string>

#include "core/require.hpp"

namespace sunfleck {

void validate(const TraceEffort& effort) {
  require(effort.paths >= kLeastUnits && effort.paths <= 1'000'000'000'000'000u, "number of paths", effort.paths,
          "from " + std::to_string(kLeastUnits) + " to 1e15");
  require(effort.threads >= 0 && effort.threads <= 4096, "number of threads", effort.threads,
          "from 0 (all cores) to 4096");
}

std::uint64_t pathsPerUnit(std::uint64_t paths) {
  return std::clamp<std::uint64_t>(std::bit_floor(paths / kLeastUnits), 1, kMostUnitPaths);
}

}  // namespace sunfleck
