#include "field/lit_places.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <array>

namespace sunfleck {

// (F6)
LitPlaces litPlaces(const SunPicture& picture, const DirectLight& direct, const LineExchange& exchange) {
  constexpr std::size_t kTask = 512;  // elements that are worth a task
  const std::size_t elements = exchange.lines.size();
  LitPlaces places{.at = std::vector<LitPlaces::Lit>(exchange.crossed_at.size()),
                   .irradiance = std::vector<float>(2 * elements),
                   .spread = std::vector<float>(2 * elements)};
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, elements, kTask), [&](const auto& range) {
    for (auto element = static_cast<std::uint32_t>(range.begin()); element != range.end(); ++element) {
      std::array<std::uint32_t, 2> lit{};  // crossings at lit places of the front and of the back
      for (std::uint32_t i = exchange.first_crossing[element]; i < exchange.first_crossing[element + 1]; ++i) {
        const std::uint32_t side = picture.litSide(element, exchange.places.place(exchange.crossed_at[i]));
        if (side == SunPicture::kNoSide) continue;
        places.at[i] = side % 2 == 0 ? LitPlaces::kFront : LitPlaces::kBack;
        ++lit[side % 2];
      }
      for (std::size_t back = 0; back < 2; ++back) {
        const std::size_t side = 2 * std::size_t{element} + back;
        // A line leaves a lit place to either side of the element.
        if (lit[back] > 0)
          places.irradiance[side] =
              direct.irradiance[side] * static_cast<float>(exchange.lines[element]) / static_cast<float>(lit[back]);
        else
          places.spread[side] = direct.irradiance[side];
      }
    }
  });
  return places;
}

}  // namespace sunfleck
