#include "field/direct_light.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <numeric>

#include "field/detail/line_grid.hpp"

namespace sunfleck {
namespace {

using detail::Crossing64;
using detail::LineGrid;

constexpr std::size_t kTask = 4096;  // triangles or lines that are worth a task
constexpr Crossing64 kNothing = std::numeric_limits<Crossing64>::max();

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
  const std::size_t lines = grid.lines();
  // The nearest crossing of each line: whichever order they are found in.
  std::vector<std::atomic<Crossing64>> nearest(lines);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, lines, kTask), [&](const auto& range) {
    for (std::size_t line = range.begin(); line != range.end(); ++line)
      nearest[line].store(kNothing, std::memory_order_relaxed);
  });
  tbb::enumerable_thread_specific<std::vector<detail::Span>> spans;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, grid.triangles(), kTask), [&](const auto& range) {
    grid.cross(range.begin(), range.end(), spans.local(), [&](std::size_t line, Crossing64 crossing) {
      Crossing64 known = nearest[line].load(std::memory_order_relaxed);
      while (crossing < known && !nearest[line].compare_exchange_weak(known, crossing, std::memory_order_relaxed)) {
      }
    });
  });
  // Whole numbers, of which the sum is the same in any order.
  std::vector<std::atomic<std::uint32_t>> pixels(2 * elements.size());
  std::atomic<std::uint64_t> free = 0;
  DirectLight light{.along = along, .irradiance = std::vector<float>(pixels.size())};
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, lines, kTask), [&](const auto& range) {
    std::uint64_t free_here = 0;
    for (std::size_t line = range.begin(); line != range.end(); ++line) {
      const Crossing64 crossing = nearest[line].load(std::memory_order_relaxed);
      if (crossing == kNothing)
        ++free_here;
      else
        pixels[detail::sideMet(crossing)].fetch_add(1, std::memory_order_relaxed);
    }
    free += free_here;
  });
  std::uint64_t met = 0;
  for (std::size_t side = 0; side < pixels.size(); ++side) {
    const std::uint32_t count = pixels[side].load(std::memory_order_relaxed);
    met += count;
    light.irradiance[side] =
        static_cast<float>(static_cast<double>(count) * grid.lineArea() / double{elements.area[side / 2]});
  }
  light.power = static_cast<double>(met) * grid.lineArea();
  if (period) light.ground_power = static_cast<double>(free) * grid.lineArea();
  return light;
}

}  // namespace sunfleck
