#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "field/detail/lanes.hpp"
#include "field/field_solver.hpp"

namespace sunfleck::detail {

// What lines return anyway is taken back up to this share: of elements that few lines cross nearly all light goes on by
// the line that it came by, and a matrix without that would hold light longer than there is any.
constexpr float kMostReturn = 1.f / 16.f;

// How light goes back where it came from at each side. Of the light that comes to an element along a line, `back` of
// what it reflects returns along that line, more than of what comes along others. Solving that for the two ends of a
// line gives (F7): each sends A + e B, where B is what the other sends by itself and e = back reflectance.
struct Returning {
  std::vector<float> back;       // of each element: near return, less what its lines return anyway
  std::vector<Lanes> own, gain;  // of each side: how much comes back of what it sends, and of all the rest

  Returning(const FieldGeometry& geometry, std::span<const KindOptics> optics)
      : back(geometry.elements.size()), own(2 * back.size()), gain(2 * back.size()) {
    const LineExchange& exchange = geometry.exchange;
    overBlocks(back.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        back[i] = geometry.near_return[geometry.kinds[i]] -
                  std::min(kMostReturn, 1.f / static_cast<float>(std::max(exchange.lines[i], 1u)));
    });
    overBlocks(back.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t side = 2 * begin; side < 2 * end; ++side) {
        Lanes sum{};
        for (std::uint64_t link = exchange.first[side]; link < exchange.first[side + 1]; ++link) {
          const std::size_t other = exchange.sees[link] / 2;
          sum += back[other] * optics[geometry.kinds[other]].reflectance;
        }
        const auto met =
            static_cast<float>(std::max<std::uint64_t>(exchange.first[side + 1] - exchange.first[side], 1));
        const Lanes here = back[side / 2] * optics[geometry.kinds[side / 2]].reflectance;
        gain[side] = 1.f / (1.f - here * sum / met);
        own[side] = gain[side] * sum;
      }
    });
  }
};

}  // namespace sunfleck::detail
