#include "field/lit_places.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <atomic>

namespace sunfleck {

// (F6)
LitPlaces litPlaces(const SunPicture& picture, const DirectLight& direct, const LineExchange& exchange) {
  constexpr std::size_t kTask = 1024;  // sides that are worth a task
  const std::size_t sides = exchange.sides();
  LitPlaces places{.seen = std::vector<LitPlaces::Lit>(exchange.sees.size()),
                   .open = std::vector<LitPlaces::Lit>(exchange.outside.size()),
                   .irradiance = std::vector<float>(sides),
                   .spread = std::vector<float>(sides)};
  // Ends of lines at lit places of each side: each place has one on either side of its element.
  std::vector<std::atomic<std::uint32_t>> ends(sides);
  const auto look = [&](std::uint32_t side, const glm::u16vec3& code) {
    const std::uint32_t lit = picture.litSide(side / 2, exchange.places.place(code));
    if (lit == SunPicture::kNoSide) return LitPlaces::kDark;
    ends[lit].fetch_add(1, std::memory_order_relaxed);
    return lit == side ? LitPlaces::kSameSide : LitPlaces::kOtherSide;
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, sides, kTask), [&](const auto& range) {
    for (std::uint64_t i = exchange.first[range.begin()]; i < exchange.first[range.end()]; ++i)
      places.seen[i] = look(exchange.sees[i], exchange.seen_at[i]);
    for (std::size_t side = range.begin(); side != range.end(); ++side)
      for (std::uint64_t i = exchange.first_outside[side]; i < exchange.first_outside[side + 1]; ++i)
        places.open[i] = look(static_cast<std::uint32_t>(side), exchange.open_at[i]);
  });
  for (std::size_t side = 0; side < sides; ++side) {
    const std::uint32_t lit = ends[side].load(std::memory_order_relaxed);
    if (lit > 0)
      places.irradiance[side] =
          direct.irradiance[side] * 2.f * static_cast<float>(exchange.lines[side / 2]) / static_cast<float>(lit);
    else
      places.spread[side] = direct.irradiance[side];
  }
  return places;
}

}  // namespace sunfleck
