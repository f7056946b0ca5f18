#include "field/wall_light.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace sunfleck {
namespace {

constexpr std::size_t kMostBands = 4;
constexpr float kDark = 1e-4f;  // share of the light that is no longer followed [1]

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
        const std::uint32_t column =
            cellNumber(grid, cell) % static_cast<std::uint32_t>(grid.size.x * grid.size.y);
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

// (F30)
void addWallLight(const LitTree& tree, const SweepGrid& grid, const CellsAlong& cells, const AroundCells& around,
                  const Direction& along, std::span<const std::uint32_t> sides, std::span<const float> per_line,
                  float pixel, std::size_t bands, std::span<float> irradiance) {
  const Axes axes = axesAlong(along);
  glm::vec2 low(std::numeric_limits<float>::infinity()), high(-low);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 p(corner & 1 ? tree.box.high.x : tree.box.low.x, corner & 2 ? tree.box.high.y : tree.box.low.y,
                      corner & 4 ? tree.box.high.z : tree.box.low.z);
    const glm::vec2 across(glm::dot(p, axes.right), glm::dot(p, axes.up));
    low = glm::min(low, across);
    high = glm::max(high, across);
  }
  const glm::ivec2 size = glm::ivec2((high - low) / pixel) + 1;
  struct Pixel {
    float way = 0.f;  // of the beginnings, sum along the light [m]
    std::uint32_t lines = 0;
    Bands light{};
  };
  std::vector<Pixel> pixels(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
  std::vector<std::uint32_t> of_line(sides.size());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const glm::vec3& centre = tree.centre[sides[i] / 2];
    const glm::ivec2 at = glm::clamp(
        glm::ivec2((glm::vec2(glm::dot(centre, axes.right), glm::dot(centre, axes.up)) - low) / pixel), glm::ivec2(0),
        size - 1);
    of_line[i] = static_cast<std::uint32_t>(at.y * size.x + at.x);
    Pixel& of_pixel = pixels[of_line[i]];
    of_pixel.way += glm::dot(centre, along);
    ++of_pixel.lines;
  }
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      Pixel& of_pixel = pixels[static_cast<std::size_t>(y * size.x + x)];
      if (of_pixel.lines == 0) continue;
      const glm::vec2 across = low + pixel * (glm::vec2(x, y) + 0.5f);
      const glm::vec3 begin = tree.position + across.x * axes.right + across.y * axes.up +
                              of_pixel.way / static_cast<float>(of_pixel.lines) * along;
      of_pixel.light = comesTo(begin, -along, tree, grid, cells, around, bands);
    }
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Pixel& of_pixel = pixels[of_line[i]];
    const float share = per_line[sides[i] / 2];
    for (std::size_t band = 0; band < bands; ++band)
      irradiance[sides[i] * bands + band] += share * of_pixel.light[band];
  }
}

}  // namespace sunfleck
