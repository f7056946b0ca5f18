#include "field/sun_picture.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>

#include "core/bounds.hpp"
#include "core/require.hpp"

namespace sunfleck {
namespace {

using detail::Crossing64;

constexpr std::size_t kTask = 4096;  // triangles or pixels that are worth a task

Direction requireGiven(Direction along, bool periodic) {
  require(std::abs(glm::length(along) - 1.f) < 1e-3f, "length of the sunlight's direction", glm::length(along), "1");
  if (periodic) require(along.z < 0.f, "z of the sunlight's direction", along.z, "below 0");
  return along;
}

double pixelAreaFor(const TreeMesh& mesh, const FieldElements& elements, Direction along,
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
SunPicture::SunPicture(const TreeMesh& mesh, const FieldElements& elements, const std::optional<glm::vec2>& period,
                       Direction along, const DirectEffort& effort)
    : elements_(&elements),
      along_(requireGiven(along, period.has_value())),
      grid_({&mesh, &elements, period}, along, pixelAreaFor(mesh, elements, along, period, effort), {0.5, 0.5}),
      nearest_(grid_.lines()) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixels(), kTask), [&](const auto& range) {
    for (std::size_t pixel = range.begin(); pixel != range.end(); ++pixel)
      nearest_[pixel].store(kNothing, std::memory_order_relaxed);
  });
  tbb::enumerable_thread_specific<std::vector<detail::Span>> spans;
  // The nearest crossing of each pixel: whichever order they are found in.
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, grid_.triangles(), kTask), [&](const auto& range) {
    grid_.cross(range.begin(), range.end(), spans.local(), [&](std::size_t pixel, Crossing64 crossing) {
      Crossing64 known = nearest_[pixel].load(std::memory_order_relaxed);
      while (crossing < known && !nearest_[pixel].compare_exchange_weak(known, crossing, std::memory_order_relaxed)) {
      }
    });
  });
}

std::uint32_t SunPicture::side(std::size_t pixel) const {
  const Crossing64 crossing = nearest_[pixel].load(std::memory_order_relaxed);
  return crossing == kNothing ? kNoSide : detail::sideMet(crossing);
}

}  // namespace sunfleck
