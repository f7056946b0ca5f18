#include "apps/sweep_task.hpp"

#include <algorithm>

#include "render/reference/trace_light.hpp"

namespace sunfleck::apps {
namespace {

std::size_t groups(const SweepFile& sweep) {
  return (sweep.optics.size() + kMostBands - 1) / kMostBands;
}

}  // namespace

std::size_t taskCount(const SweepFile& sweep) {
  return sweep.scenes.size() * sweep.suns.size() * groups(sweep);
}

SweepTask taskAt(const SweepFile& sweep, std::size_t number) {
  const std::size_t first = number % groups(sweep) * kMostBands, of_sun = number / groups(sweep);
  const std::span<const SweepOptics> optics(sweep.optics);
  return {.scene = of_sun / sweep.suns.size(),
          .sun = sweep.suns[of_sun % sweep.suns.size()],
          .optics = optics.subspan(first, std::min(kMostBands, optics.size() - first))};
}

}  // namespace sunfleck::apps
