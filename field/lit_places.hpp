#pragma once

#include <cstdint>
#include <vector>

#include "field/direct_light.hpp"
#include "field/line_exchange.hpp"
#include "field/sun_picture.hpp"

namespace sunfleck {

// (F6) Where a sun's light falls on elements: what a line sees of an element is lit or not, and light is scattered for
// the first time from where it falls. It leaves rather through the gap that it came by than an evenly lit leaf would
// have it.
struct LitPlaces {
  enum Lit : std::uint8_t { kDark, kFront, kBack };
  std::vector<Lit> at;  // of each crossing of the exchange's lines, the side that is lit there
  // Irradiance of each side where it is lit: as much as lets its lines carry away all light that arrives at it [1].
  std::vector<float> irradiance;
  // Of sides none of whose lit places a line meets: of the whole side [1].
  std::vector<float> spread;
};

LitPlaces litPlaces(const SunPicture& picture, const DirectLight& direct, const LineExchange& exchange);

}  // namespace sunfleck
