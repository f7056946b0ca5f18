#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/bounds.hpp"
#include "core/directions.hpp"

namespace sunfleck {

// Finds the trees of a stand that a tree may meet along an axis. Of a periodic stand it knows the copies too.
class StandIndex {
 public:
  StandIndex() = default;
  // Trees that stand nowhere have a position that is not a number: they are left out.
  //   reach   about the width of a tree [m], > 0: the side of the index's squares
  //   period  of the stand [m]; copies up to `around` periods away are kept
  StandIndex(std::span<const glm::vec3> positions, float reach, std::optional<glm::vec2> period, glm::ivec2 around);

  // Calls visit(tree, displacement) for all trees and copies, displaced from `from` [m] by a vector d for which the
  // line through the origin along `axis` meets the box `reached` moved by d; for some others too. The displacement of a
  // copy of `tree` is (its position - from) + its shift, so that the way back is its exact opposite.
  //   reached  the tree's box less the points of the box it is met from: Minkowski's difference
  template <typename Visit>
  void along(const glm::vec3& from, const Bounds& reached, const Direction& axis, const Visit& visit) const;

 private:
  struct Entry {
    std::uint32_t tree;
    glm::vec3 position, shift;  // shift: of the copy, 0 for the tree itself
  };
  std::size_t squareNumber(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.x) + static_cast<std::size_t>(x);
  }

  float side_ = 1.f;  // of a square [m]
  glm::vec2 low_{0.f};
  glm::ivec2 size_{0};
  glm::vec2 heights_{0.f};            // lowest and highest position [m]
  std::vector<std::uint32_t> first_;  // entries of square i are [first[i], first[i + 1])
  std::vector<Entry> entries_;
};

template <typename Visit>
void StandIndex::along(const glm::vec3& from, const Bounds& reached, const Direction& axis, const Visit& visit) const {
  if (entries_.empty()) return;
  constexpr float infinity = std::numeric_limits<float>::infinity();
  // Distances t along the axis at which a tree may be met: t axis lies in `reached` + d, for the least and greatest d.
  glm::vec2 way(-infinity, infinity);
  const auto clip = [&](glm::vec2& range, int coordinate, float least, float greatest) {
    if (std::abs(axis[coordinate]) < 1e-6f) return;
    const float a = (least + reached.low[coordinate]) / axis[coordinate];
    const float b = (greatest + reached.high[coordinate]) / axis[coordinate];
    range = {std::max(range.x, std::min(a, b)), std::min(range.y, std::max(a, b))};
  };
  clip(way, 2, heights_.x - from.z, heights_.y - from.z);
  const int major = std::abs(axis.x) >= std::abs(axis.y) ? 0 : 1, minor = 1 - major;
  const auto least = [&](int coordinate) { return low_[coordinate] - from[coordinate]; };
  clip(way, major, least(major), least(major) + side_ * static_cast<float>(size_[major]));
  if (!(way.x <= way.y)) return;

  // Squares that hold displacements d = t axis - (a point of `reached`) for t in a range.
  const auto squares = [&](int coordinate, const glm::vec2& range) {
    const float a = range.x * axis[coordinate], b = range.y * axis[coordinate];
    const bool level = std::abs(axis[coordinate]) < 1e-6f;
    const float low = (level ? 0.f : std::min(a, b)) - reached.high[coordinate] - least(coordinate);
    const float high = (level ? 0.f : std::max(a, b)) - reached.low[coordinate] - least(coordinate);
    const auto bound = static_cast<float>(size_[coordinate]);
    // Two rounded figures may put a tree beside its square: 1e-3 of a square is far more than they can be off.
    return glm::ivec2(std::clamp(std::floor(low / side_ - 1e-3f), 0.f, bound),
                      std::clamp(std::floor(high / side_ + 1e-3f), -1.f, bound - 1.f));
  };
  const glm::ivec2 columns = squares(major, way);
  for (int i = columns.x; i <= columns.y; ++i) {
    glm::vec2 here = way;
    clip(here, major, least(major) + side_ * static_cast<float>(i), least(major) + side_ * static_cast<float>(i + 1));
    if (!(here.x <= here.y)) continue;
    const glm::ivec2 rows = squares(minor, here);
    for (int j = rows.x; j <= rows.y; ++j) {
      const std::size_t square = major == 0 ? squareNumber(i, j) : squareNumber(j, i);
      for (std::uint32_t e = first_[square]; e < first_[square + 1]; ++e)
        visit(entries_[e].tree, (entries_[e].position - from) + entries_[e].shift);
    }
  }
}

}  // namespace sunfleck
