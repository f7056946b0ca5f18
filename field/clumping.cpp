#include "field/clumping.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/require.hpp"
#include "grid/deep_opacity_map.hpp"

namespace sunfleck {
namespace {

// A part of a line through the tree.
struct Stretch {
  float depth = 0.f;  // leaves that it would meet if they stood at random in each cell, in the mean
  bool met = false;   // whether it meets any
};

// Crossings per metre in each slot along an axis.
std::vector<float> extinctionAlong(const CellMedium& medium, const Direction& axis) {
  std::vector<float> sigma(medium.grid.cells.size());
  for (std::size_t slot = 0; slot < sigma.size(); ++slot) {
    double sum = 0.;
    for (std::uint32_t i = medium.first_piece[slot]; i < medium.first_piece[slot + 1]; ++i) {
      const CellPiece& piece = medium.pieces[i];
      if (medium.material[piece.element] % 2 == 0)
        sum += double{piece.area * std::abs(glm::dot(medium.normal[piece.element], axis))};
    }
    sigma[slot] = static_cast<float>(sum / double{medium.grid.volume()});
  }
  return sigma;
}

// Follows the line of a pixel through the cells and cuts it into stretches.
void stretchesOf(const DeepOpacityMap& map, int x, int y, const SweepGrid& grid, std::span<const float> sigma,
                 float most_depth, std::vector<Stretch>& stretches) {
  const glm::vec3 start = map.inSpace(x, y, 0.f), along = map.along();
  const glm::vec3 high = grid.low + grid.side * glm::vec3(grid.size);
  float at = -std::numeric_limits<float>::infinity(), end = std::numeric_limits<float>::infinity();
  for (int a = 0; a < 3; ++a) {
    if (std::abs(along[a]) < 1e-6f) {
      if (start[a] < grid.low[a] || start[a] > high[a]) return;
      continue;
    }
    const float one = (grid.low[a] - start[a]) / along[a], other = (high[a] - start[a]) / along[a];
    at = std::max(at, std::min(one, other));
    end = std::min(end, std::max(one, other));
  }
  const std::span<const Crossing> crossings = map.crossings(x, y);
  auto next = crossings.begin();
  Stretch stretch;
  while (at < end) {
    // The cell a little farther on, so that a start on a face is in the cell behind it.
    const float step = 1e-4f * grid.side.x;
    const glm::ivec3 cell = glm::clamp(glm::ivec3(glm::floor((start + (at + step) * along - grid.low) / grid.side)),
                                       glm::ivec3(0), grid.size - 1);
    float leave = end;
    for (int a = 0; a < 3; ++a) {
      if (std::abs(along[a]) < 1e-6f) continue;
      const float face = grid.low[a] + grid.side[a] * static_cast<float>(cell[a] + (along[a] > 0.f ? 1 : 0));
      leave = std::min(leave, std::max((face - start[a]) / along[a], at + step));
    }
    const std::uint32_t slot =
        grid.slot[static_cast<std::size_t>((cell.z * grid.size.y + cell.y) * grid.size.x + cell.x)];
    if (slot != SweepGrid::kEmpty) stretch.depth += sigma[slot] * (leave - at);
    for (; next != crossings.end() && next->depth < leave; ++next) stretch.met = true;
    if (stretch.depth >= most_depth) {
      stretches.push_back(stretch);
      stretch = {};
    }
    at = leave;
  }
  if (stretch.depth > 0.f) stretches.push_back(stretch);
}

}  // namespace

// (F19)
float clumping(const TreeMesh& mesh, const CellMedium& medium, const ClumpingEffort& effort) {
  require(effort.axes >= 1 && effort.axes <= 128, "axes of clumping", effort.axes, "1 to 128");
  require(effort.resolution >= 1 && effort.resolution <= 4096, "resolution of clumping", effort.resolution,
          "1 to 4096");
  require(effort.depth > 0.f, "depth of clumping", effort.depth, "above 0");
  std::vector<Stretch> stretches;
  for (const Direction& axis : spreadAxes(effort.axes)) {
    const DeepOpacityMap map(mesh, axis, effort.resolution, DeepOpacityMap::Wood::none);
    const std::vector<float> sigma = extinctionAlong(medium, axis);
    std::vector<std::vector<Stretch>> rows(static_cast<std::size_t>(map.size().y));
    tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t y) {
      for (int x = 0; x < map.size().x; ++x)
        stretchesOf(map, x, static_cast<int>(y), medium.grid, sigma, effort.depth, rows[y]);
    });
    for (const auto& row : rows) stretches.insert(stretches.end(), row.begin(), row.end());
  }
  // Newton's steps from where leaves are as they seem: the sum is concave in Omega, so that they only go on.
  double met = 0.;
  for (const Stretch& stretch : stretches) met += stretch.met;
  double omega = 0.;
  constexpr int steps = 6;  // each doubles the digits; from 0 the first is met / sum tau
  for (int step = 0; step < steps; ++step) {
    double expected = 0., slope = 0.;
    for (const Stretch& stretch : stretches) {
      const double passing = std::exp(-omega * double{stretch.depth});
      expected += 1. - passing;
      slope += double{stretch.depth} * passing;
    }
    if (!(slope > 0.)) break;
    omega = std::min(omega + (met - expected) / slope, 1.);
  }
  return static_cast<float>(std::clamp(omega, 0.01, 1.));
}

}  // namespace sunfleck
