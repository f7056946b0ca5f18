#include "grid/instance_cells.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "grid/neighbours.hpp"
#include "spp/compensation.hpp"

namespace sunfleck {
namespace {

constexpr int kSamples = 3;      // points per cell and axis at which depths are looked up
constexpr float kOpaque = 60.f;  // more crossings than this let e^-60 through: nothing

glm::ivec3 cellAt(const CellGrid& grid, std::size_t number) {
  const int i = static_cast<int>(number);
  return {i % grid.size.x, i / grid.size.x % grid.size.y, i / (grid.size.x * grid.size.y)};
}

std::size_t numberOf(const CellGrid& grid, glm::ivec3 cell) {
  return static_cast<std::size_t>((cell.z * grid.size.y + cell.y) * grid.size.x + cell.x);
}

glm::ivec3 cellHolding(const CellGrid& grid, glm::vec3 point) {
  return glm::clamp(glm::ivec3(glm::floor((point - grid.low) / grid.cell_size)), glm::ivec3(0), grid.size - 1);
}

// Calls visit(point) at kSamples^3 points spread evenly over a cell.
template <typename Visit>
void forPointsOf(const CellGrid& grid, std::size_t cell, const Visit& visit) {
  const glm::vec3 low = grid.lowCorner(cell);
  const float step = grid.cell_size / kSamples;
  for (int z = 0; z < kSamples; ++z)
    for (int y = 0; y < kSamples; ++y)
      for (int x = 0; x < kSamples; ++x) visit(low + step * (glm::vec3(glm::ivec3(x, y, z)) + 0.5f));
}
constexpr float kPoints = kSamples * kSamples * kSamples;

}  // namespace

glm::vec3 CellGrid::lowCorner(std::size_t cell) const {
  return low + cell_size * glm::vec3(cellAt(*this, cell));
}

CellGrid cellGrid(const TreeMesh& mesh, int resolution) {
  CellGrid grid;
  grid.leaves = leafBounds(mesh);
  const glm::vec3 extent = grid.leaves.size();
  grid.cell_size = std::max({extent.x, extent.y, extent.z, 1e-6f}) / static_cast<float>(resolution);
  grid.size = glm::clamp(glm::ivec3(glm::ceil(extent / grid.cell_size)), 1, resolution);
  grid.low = grid.leaves.centre() - 0.5f * grid.cell_size * glm::vec3(grid.size);
  const auto count = static_cast<std::size_t>(grid.size.x) * static_cast<std::size_t>(grid.size.y) *
                     static_cast<std::size_t>(grid.size.z);
  grid.active.assign(count, false);
  // A leaf makes all cells of its triangles' boxes active, and one layer around them.
  for (const glm::uvec3& t : mesh.leaf_triangles) {
    Bounds box;
    for (int corner = 0; corner < 3; ++corner) box.include(mesh.vertices[t[corner]]);
    const glm::ivec3 low = glm::max(cellHolding(grid, box.low) - 1, 0);
    const glm::ivec3 high = glm::min(cellHolding(grid, box.high) + 1, grid.size - 1);
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) grid.active[numberOf(grid, {x, y, z})] = true;
  }
  return grid;
}

std::vector<float> cellDepths(const CellGrid& grid, std::span<const DeepOpacityMap> maps,
                              std::span<const glm::vec3> neighbours) {
  std::vector<std::vector<glm::vec3>> met;
  met.reserve(maps.size());
  for (const DeepOpacityMap& map : maps) met.push_back(neighboursAlong(neighbours, grid.leaves, map.along(), true));

  std::vector<float> depths(2 * grid.count() * maps.size(), 0.f);
  tbb::parallel_for(std::size_t{0}, grid.count(), [&](std::size_t cell) {
    if (!grid.active[cell]) return;
    for (std::size_t j = 0; j < maps.size(); ++j) {
      float along = 0.f, against = 0.f;
      const auto add = [&](glm::vec3 point) {
        const DeepOpacityMap::Counts counts = maps[j].counts(point);
        along += static_cast<float>(counts.beyond);
        against += static_cast<float>(counts.before);
      };
      forPointsOf(grid, cell, add);
      for (const glm::vec3& t : met[j]) {
        if (std::min(along, against) > kOpaque * kPoints) break;
        forPointsOf(grid, cell, [&](glm::vec3 point) { add(point - t); });
      }
      float* const depth = &depths[2 * (cell * maps.size() + j)];
      depth[0] = along / kPoints;
      depth[1] = against / kPoints;
    }
  });
  return depths;
}

std::vector<float> cellCompensation(const CellGrid& grid, std::span<const DeepOpacityMap> maps,
                                    std::span<const float> depths, const DeepOpacityMap& light,
                                    std::span<const glm::vec3> neighbours) {
  const std::vector<glm::vec3> met = neighboursAlong(neighbours, grid.leaves, light.along(), true);
  constexpr float mu0 = 1.f;   // the slab's normal is the light's axis
  std::vector<float> cosines;  // of both directions of each axis to the direction back to the light
  for (const DeepOpacityMap& map : maps) {
    const float cosine = -glm::dot(map.along(), light.along());
    cosines.insert(cosines.end(), {cosine, -cosine});
  }
  std::vector<float> compensation(grid.count(), 0.f);
  tbb::parallel_for(std::size_t{0}, grid.count(), [&](std::size_t cell) {
    if (!grid.active[cell]) return;
    float before = 0.f, beyond = 0.f;
    const auto add = [&](glm::vec3 point) {
      const DeepOpacityMap::Counts counts = light.counts(point);
      before += static_cast<float>(counts.before);
      beyond += static_cast<float>(counts.beyond);
    };
    forPointsOf(grid, cell, [&](glm::vec3 point) {
      add(point);
      for (const glm::vec3& t : met) add(point - t);
    });
    compensation[cell] = spp::compensation(cosines, depths.subspan(cell * cosines.size(), cosines.size()),
                                           before / kPoints, (before + beyond) / kPoints, mu0);
  });
  return compensation;
}

float interpolate(const CellGrid& grid, std::span<const float> values, glm::vec3 point) {
  const glm::vec3 at = glm::clamp((point - grid.low) / grid.cell_size - 0.5f, glm::vec3(0.f), glm::vec3(grid.size - 1));
  const glm::ivec3 low = glm::min(glm::ivec3(at), grid.size - 1);
  const glm::ivec3 high = glm::min(low + 1, grid.size - 1);
  const glm::vec3 part = at - glm::vec3(low);
  const auto value = [&](int x, int y, int z) { return values[numberOf(grid, {x, y, z})]; };
  const auto along_x = [&](int y, int z) { return glm::mix(value(low.x, y, z), value(high.x, y, z), part.x); };
  return glm::mix(glm::mix(along_x(low.y, low.z), along_x(high.y, low.z), part.y),
                  glm::mix(along_x(low.y, high.z), along_x(high.y, high.z), part.y), part.z);
}

}  // namespace sunfleck
