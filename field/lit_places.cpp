#include "field/lit_places.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

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
  struct Work {
    std::vector<std::uint32_t> ends, elements, lit;
    std::vector<glm::vec3> where;
  };
  tbb::enumerable_thread_specific<Work> works;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, sides, kTask), [&](const auto& range) {
    Work& work = works.local();
    work.ends.resize(sides);
    // Looks from the sides sideOf(i) of elements at places, i in [begin, end).
    const auto look = [&](std::uint64_t begin, std::uint64_t end, const auto& sideOf,
                          const std::vector<glm::u16vec3>& codes, std::vector<LitPlaces::Lit>& result) {
      work.elements.clear();
      work.where.clear();
      work.lit.resize(end - begin);
      for (std::uint64_t i = begin; i < end; ++i) {
        work.elements.push_back(sideOf(i) / 2);
        work.where.push_back(exchange.places.place(codes[i]));
      }
      picture.litSides(work.elements, work.where, work.lit);
      for (std::uint64_t i = begin; i < end; ++i) {
        const std::uint32_t lit = work.lit[i - begin];
        if (lit == SunPicture::kNoSide) continue;
        ++work.ends[lit];
        result[i] = lit == sideOf(i) ? LitPlaces::kSameSide : LitPlaces::kOtherSide;
      }
    };
    look(
        exchange.first[range.begin()], exchange.first[range.end()], [&](std::uint64_t i) { return exchange.sees[i]; },
        exchange.seen_at, places.seen);
    for (std::size_t side = range.begin(); side != range.end(); ++side)
      look(
          exchange.first_outside[side], exchange.first_outside[side + 1],
          [&](std::uint64_t) { return static_cast<std::uint32_t>(side); }, exchange.open_at, places.open);
  });
  std::vector<std::uint32_t> ends(sides);
  for (const Work& work : works)
    for (std::size_t side = 0; side < work.ends.size(); ++side) ends[side] += work.ends[side];
  for (std::size_t side = 0; side < sides; ++side) {
    const std::uint32_t lit = ends[side];
    if (lit > 0)
      places.irradiance[side] =
          direct.irradiance[side] * 2.f * static_cast<float>(exchange.lines[side / 2]) / static_cast<float>(lit);
    else
      places.spread[side] = direct.irradiance[side];
  }
  return places;
}

}  // namespace sunfleck
