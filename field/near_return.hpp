#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "field/elements.hpp"
#include "field/line_exchange.hpp"

namespace sunfleck {

// (F7) How much more often light that comes from a leaf to an element and is reflected there goes back to that leaf
// than if it were reflected from anywhere on the element: two lines from one place meet the same leaf more often than
// two lines from different places do. The first is extrapolated from pairs of lines close to each other. One number for
// each kind of element, 0 for wood [1], 0 .. 1.
//   kinds  of each element, below `count`; those of leaves and of wood differ
std::vector<float> nearReturn(const FieldElements& elements, const LineExchange& exchange,
                              std::span<const std::uint32_t> kinds, std::size_t count);

}  // namespace sunfleck
