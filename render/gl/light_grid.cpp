#include "render/gl/light_grid.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace sunfleck::gl {
namespace {

constexpr float kCellsAcross = 4.f;  // cells across a map: lists then hold few trees that a place does not need
constexpr int kMostCells = 1024;     // along a side

bool meet(const LightBox& a, const LightBox& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y;
}

}  // namespace

LightBox across(const Axes& axes, const Bounds& box) {
  if (box.empty()) return {};
  const glm::vec3 half = 0.5f * box.size();
  const glm::vec2 centre(glm::dot(box.centre(), axes.right), glm::dot(box.centre(), axes.up));
  const glm::vec2 reach(glm::dot(half, glm::abs(axes.right)), glm::dot(half, glm::abs(axes.up)));
  return {centre - reach, centre + reach};
}

LightGrid lightGrid(std::span<const LightBox> casters, const LightBox& lit) {
  LightGrid grid;
  glm::vec2 mean(0.f);
  std::vector<std::uint32_t> met;
  for (std::uint32_t i = 0; i < casters.size(); ++i)
    if (meet(casters[i], lit)) {
      met.push_back(i);
      mean += casters[i].high - casters[i].low;
    }
  if (met.empty()) return grid;
  mean /= static_cast<float>(met.size());
  // Lists that would be empty cost nothing but memory: no grid wider than the trees.
  LightBox used{glm::vec2(std::numeric_limits<float>::infinity()), glm::vec2(-std::numeric_limits<float>::infinity())};
  for (const std::uint32_t i : met) {
    used.low = glm::min(used.low, casters[i].low);
    used.high = glm::max(used.high, casters[i].high);
  }
  used.low = glm::max(used.low, lit.low);
  used.high = glm::min(used.high, lit.high);
  const glm::vec2 extent = glm::max(used.high - used.low, glm::vec2(1e-6f));
  grid.low = used.low;
  grid.cell_size = std::max({0.5f * (mean.x + mean.y) / kCellsAcross, extent.x / kMostCells, extent.y / kMostCells});
  grid.size = glm::clamp(glm::ivec2(glm::ceil(extent / grid.cell_size)), 1, kMostCells + 1);

  const auto forCells = [&](const LightBox& box, const auto& visit) {
    const auto cell = [&](const glm::vec2& at) {
      return glm::clamp(glm::ivec2(glm::floor((at - grid.low) / grid.cell_size)), glm::ivec2(0), grid.size - 1);
    };
    const glm::ivec2 low = cell(box.low), high = cell(box.high);
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x) visit(static_cast<std::size_t>(y * grid.size.x + x));
  };
  const auto cells = static_cast<std::size_t>(grid.size.x * grid.size.y);
  grid.first.assign(cells + 1, 0);
  for (const std::uint32_t i : met) forCells(casters[i], [&](std::size_t cell) { ++grid.first[cell + 1]; });
  for (std::size_t cell = 0; cell < cells; ++cell) grid.first[cell + 1] += grid.first[cell];
  grid.casters.resize(grid.first.back());
  std::vector<std::uint32_t> next(grid.first.begin(), grid.first.end() - 1);
  for (const std::uint32_t i : met) forCells(casters[i], [&](std::size_t cell) { grid.casters[next[cell]++] = i; });
  return grid;
}

}  // namespace sunfleck::gl
