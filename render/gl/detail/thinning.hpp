#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace sunfleck::gl::detail {

// Ranks of so many pieces: the numbers (i + 1/2) / count in a random order, the same each time [1], 0 .. 1.
std::vector<float> ranks(std::size_t count);

// (R25) Enlargement of each piece's length in a level, 0 for those left out: a piece is kept if its rank is below its
// area's share of `piece_area`, and then has that area, times what it takes to keep the area of all.
std::vector<float> thinned(std::span<const double> areas, std::span<const float> ranks, double piece_area);

}  // namespace sunfleck::gl::detail
