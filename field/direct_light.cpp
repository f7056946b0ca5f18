#include "field/direct_light.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <atomic>

namespace sunfleck {

// (F3)
DirectLight directLight(const SunPicture& picture, const FieldElements& elements, bool periodic) {
  constexpr std::size_t kTask = 4096;  // pixels that are worth a task
  // Whole numbers, of which the sum is the same in any order.
  std::vector<std::atomic<std::uint32_t>> pixels(2 * elements.size());
  std::atomic<std::uint64_t> free = 0;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, picture.pixels(), kTask), [&](const auto& range) {
    std::uint64_t free_here = 0;
    for (std::size_t pixel = range.begin(); pixel != range.end(); ++pixel) {
      const std::uint32_t side = picture.side(pixel);
      if (side == SunPicture::kNoSide)
        ++free_here;
      else
        pixels[side].fetch_add(1, std::memory_order_relaxed);
    }
    free += free_here;
  });
  DirectLight light{.along = picture.along(), .irradiance = std::vector<float>(pixels.size())};
  std::uint64_t met = 0;
  for (std::size_t side = 0; side < pixels.size(); ++side) {
    const std::uint32_t count = pixels[side].load(std::memory_order_relaxed);
    met += count;
    light.irradiance[side] =
        static_cast<float>(static_cast<double>(count) * picture.pixelArea() / double{elements.area[side / 2]});
  }
  light.power = static_cast<double>(met) * picture.pixelArea();
  if (periodic) light.ground_power = static_cast<double>(free) * picture.pixelArea();
  return light;
}

DirectLight directLight(const TreeMesh& mesh, const FieldElements& elements, const std::optional<glm::vec2>& period,
                        Direction along, const DirectEffort& effort) {
  return directLight(SunPicture(mesh, elements, period, along, effort), elements, period.has_value());
}

}  // namespace sunfleck
