#include "field/direct_light.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <numeric>

#include "field/detail/line_grid.hpp"

namespace sunfleck {
namespace {

using detail::Crossing64;
using detail::LineGrid;

constexpr std::size_t kBands = 32;   // of lines, each worth a task
constexpr std::size_t kTask = 4096;  // triangles that are worth a task
constexpr Crossing64 kNothing = std::numeric_limits<Crossing64>::max();

struct Found {
  std::array<std::vector<std::pair<std::uint32_t, Crossing64>>, kBands> bands;
  std::vector<detail::Span> spans;
};

double lineArea(const TreeMesh& mesh, const FieldElements& elements, Direction along,
                const std::optional<glm::vec2>& period, const DirectEffort& effort) {
  const double leaf_area =
      std::accumulate(elements.area.begin(),
                      elements.area.begin() + static_cast<std::ptrdiff_t>(elements.leaf_elements), 0.) /
      static_cast<double>(elements.leaf_elements);
  const glm::dvec3 size(bounds(mesh).size());
  const glm::dvec3 s = glm::abs(glm::dvec3(along));
  const double picture = period ? double{period->x} * double{period->y} * s.z
                                : size.x * size.y * s.z + size.y * size.z * s.x + size.x * size.z * s.y;
  return std::max(leaf_area / double{effort.pixels}, picture / effort.most_pixels);
}

}  // namespace

// (F3)
DirectLight directLight(const TreeMesh& mesh, const FieldElements& elements, const std::optional<glm::vec2>& period,
                        Direction along, const DirectEffort& effort) {
  const LineGrid grid({&mesh, &elements, period}, along, lineArea(mesh, elements, along, period, effort), {0.5, 0.5});
  const std::size_t lines = grid.lines(), per_band = (lines + kBands - 1) / kBands;
  tbb::enumerable_thread_specific<Found> threads;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, grid.triangles(), kTask), [&](const auto& range) {
    Found& found = threads.local();
    grid.cross(range.begin(), range.end(), found.spans, [&](std::size_t line, Crossing64 crossing) {
      found.bands[line / per_band].emplace_back(static_cast<std::uint32_t>(line), crossing);
    });
  });
  std::vector<const Found*> finders;
  for (const Found& found : threads) finders.push_back(&found);
  // Whole numbers, of which the sum is the same in any order.
  std::vector<std::atomic<std::uint32_t>> pixels(2 * elements.size());
  std::array<std::uint64_t, kBands> free{};
  tbb::parallel_for(std::size_t{0}, kBands, [&](std::size_t band) {
    const std::size_t begin = std::min(lines, band * per_band), end = std::min(lines, begin + per_band);
    std::vector<Crossing64> nearest(end - begin, kNothing);
    for (const Found* found : finders)
      for (const auto& [line, crossing] : found->bands[band]) {
        Crossing64& of_line = nearest[line - begin];
        of_line = std::min(of_line, crossing);
      }
    for (const Crossing64 crossing : nearest)
      if (crossing == kNothing)
        ++free[band];
      else
        pixels[detail::sideMet(crossing)].fetch_add(1, std::memory_order_relaxed);
  });
  DirectLight light{.along = along, .irradiance = std::vector<float>(pixels.size())};
  std::uint64_t met = 0;
  for (std::size_t side = 0; side < pixels.size(); ++side) {
    const std::uint32_t count = pixels[side].load(std::memory_order_relaxed);
    met += count;
    light.irradiance[side] =
        static_cast<float>(static_cast<double>(count) * grid.lineArea() / double{elements.area[side / 2]});
  }
  light.power = static_cast<double>(met) * grid.lineArea();
  if (period)
    light.ground_power =
        static_cast<double>(std::accumulate(free.begin(), free.end(), std::uint64_t{0})) * grid.lineArea();
  return light;
}

}  // namespace sunfleck
