#include "field/wall_light.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace sunfleck {
namespace {

constexpr std::size_t kMostBands = 4;
constexpr float kDark = 1e-3f;  // share of the light that is no longer followed [1]

using Bands = std::array<float, kMostBands>;

// The light that comes to a point along a line, from where it is followed back outward.
Bands comesTo(const glm::vec3& point, const glm::vec3& outward, const LitTree& tree, const SweepGrid& grid,
              const CellsAlong& cells, const AroundCells& around, std::size_t bands) {
  Bands light{};
  float passing = 1.f;
  const auto add = [&](const float* radiance, float share) {
    for (std::size_t band = 0; band < bands; ++band) light[band] += share * radiance[band];
  };
  // In cells, from the grid's corner.
  glm::vec3 at = (point - grid.low) / grid.side;
  const glm::vec3 step = outward / grid.side;
  glm::ivec3 cell(glm::floor(at));
  for (int a = 0; a < 3; ++a)
    if (a == 2 || !grid.periodic) cell[a] = std::clamp(cell[a], 0, grid.size[a] - 1);
  glm::ivec3 forward;
  glm::vec3 next, per;  // way to the next face of each axis, and from face to face [m]
  for (int a = 0; a < 3; ++a) {
    forward[a] = step[a] > 0.f ? 1 : -1;
    const float size = std::max(std::abs(step[a]), 1e-9f);
    per[a] = 1.f / size;
    const float face = static_cast<float>(cell[a] + (step[a] > 0.f ? 1 : 0));
    next[a] = std::max(0.f, (face - at[a]) / (step[a] > 0.f ? size : -size));
  }
  float gone = 0.f;
  for (;;) {
    const int axis = next.x < next.y ? (next.x < next.z ? 0 : 2) : (next.y < next.z ? 1 : 2);
    const std::uint32_t slot = grid.slot[cellNumber(grid, cell)];
    if (slot != SweepGrid::kEmpty) {
      const glm::ivec3 in_tree = cell - tree.low;
      float others = 1.f;
      if (in_tree.x >= 0 && in_tree.y >= 0 && in_tree.z >= 0 && in_tree.x < tree.size.x && in_tree.y < tree.size.y &&
          in_tree.z < tree.size.z)
        others -= tree.own[static_cast<std::size_t>((in_tree.z * tree.size.y + in_tree.y) * tree.size.x + in_tree.x)];
      const float depth = others * cells.extinction[slot] * (next[axis] - gone);
      if (depth > 0.f) {
        const float through = std::exp(-depth);
        add(cells.radiance.data() + slot * bands, passing * (1.f - through));
        passing *= through;
        if (passing < kDark) return light;
      }
    }
    gone = next[axis];
    cell[axis] += forward[axis];
    next[axis] += per[axis];
    if (axis == 2) {
      if (cell.z >= grid.size.z) break;
      if (cell.z < 0) {
        cell.z = 0;
        const std::uint32_t column = cellNumber(grid, cell) % static_cast<std::uint32_t>(grid.size.x * grid.size.y);
        if (!around.ground.empty()) add(around.ground.data() + column * bands, passing);
        return light;
      }
    } else if (!grid.periodic && (cell[axis] < 0 || cell[axis] >= grid.size[axis])) {
      break;
    }
  }
  if (outward.z > 0.f)
    add(around.sky.data(), passing);
  else if (!around.open.empty())
    add(around.open.data(), passing);
  return light;
}

}  // namespace

OutsideLines outsideLines(const LineExchange& exchange) {
  OutsideLines lines{.first = std::vector<std::uint32_t>(exchange.directions.size() + 1),
                     .side = std::vector<std::uint32_t>(exchange.outside.size())};
  for (const std::uint16_t direction : exchange.outside) ++lines.first[direction + 1u];
  for (std::size_t i = 1; i < lines.first.size(); ++i) lines.first[i] += lines.first[i - 1];
  std::vector<std::uint32_t> next = lines.first;
  for (std::uint32_t side = 0; side < exchange.sides(); ++side)
    for (std::uint64_t i = exchange.first_outside[side]; i < exchange.first_outside[side + 1]; ++i)
      lines.side[next[exchange.outside[i]]++] = side;
  return lines;
}

WallPixels wallPixels(std::span<const glm::vec3> centre, std::span<const std::uint32_t> sides, const Direction& along,
                      float pixel) {
  const Axes axes = axesAlong(along);
  WallPixels pixels{.along = along, .of_line = std::vector<std::uint32_t>(sides.size()), .begin = {}};
  std::vector<glm::vec2> across(sides.size());
  glm::vec2 low(std::numeric_limits<float>::infinity()), high(-low);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    across[i] = {glm::dot(centre[sides[i] / 2], axes.right), glm::dot(centre[sides[i] / 2], axes.up)};
    low = glm::min(low, across[i]);
    high = glm::max(high, across[i]);
  }
  if (sides.empty()) return pixels;
  const glm::ivec2 size = glm::ivec2((high - low) / pixel) + 1;
  constexpr std::uint32_t none = ~0u;
  std::vector<std::uint32_t> number(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y), none);
  std::vector<float> lines;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const glm::ivec2 at((across[i] - low) / pixel);
    std::uint32_t& of_pixel = number[static_cast<std::size_t>(at.y * size.x + at.x)];
    if (of_pixel == none) {
      of_pixel = static_cast<std::uint32_t>(lines.size());
      lines.push_back(0.f);
      pixels.begin.emplace_back(0.f);
    }
    pixels.of_line[i] = of_pixel;
    pixels.begin[of_pixel] += centre[sides[i] / 2];
    lines[of_pixel] += 1.f;
  }
  for (std::size_t i = 0; i < lines.size(); ++i) pixels.begin[i] /= lines[i];
  return pixels;
}

// (F29)
void addWallLight(const LitTree& tree, const SweepGrid& grid, const CellsAlong& cells, const AroundCells& around,
                  const WallPixels& pixels, std::span<const std::uint32_t> sides, std::span<const float> per_line,
                  std::size_t bands, std::span<float> irradiance) {
  std::vector<Bands> light(pixels.begin.size());
  for (std::size_t i = 0; i < light.size(); ++i)
    light[i] = comesTo(tree.position + pixels.begin[i], -pixels.along, tree, grid, cells, around, bands);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Bands& of_pixel = light[pixels.of_line[i]];
    const float share = per_line[sides[i] / 2];
    float* const to = irradiance.data() + sides[i] * bands;
    for (std::size_t band = 0; band < bands; ++band) to[band] += share * of_pixel[band];
  }
}

}  // namespace sunfleck
