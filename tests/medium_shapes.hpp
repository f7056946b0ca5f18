#pragma once

#include <limits>
#include <utility>
#include <vector>

#include "core/random.hpp"
#include "render/reference/trace_medium.hpp"
#include "scattering/leaf_angles.hpp"

// Media for tests.
namespace sunfleck::shapes {

inline constexpr float kEndless = std::numeric_limits<float>::infinity();

// A layer without end, of thickness 1 m.
inline TraceMedium layer(TraceMedium::Scatterer scatterer, float density) {
  return {.scatterer = scatterer,
          .box = {.low = {-kEndless, -kEndless, 0.f}, .high = {kEndless, kEndless, 1.f}},
          .density = density};
}

inline std::vector<LeafRing> ringsOf(const LeafAngles& angles) {
  std::vector<LeafRing> rings;
  for (const LeafAngles::Node& node : angles.nodes())
    rings.push_back({static_cast<float>(node.cosine), static_cast<float>(node.weight)});
  return rings;
}

// Cells of this side over a box of `size` cells, of the densities that `density(cell)` tells.
template <typename Density>
MediumVoxels voxels(const glm::vec3& corner, float cell_size, const glm::ivec3& size, const Density& density) {
  MediumVoxels made{.corner = corner, .cell_size = cell_size};
  const glm::ivec3 blocks = (size + MediumVoxels::kSide - 1) / MediumVoxels::kSide;
  for (int x = 0; x < blocks.x; ++x)
    for (int y = 0; y < blocks.y; ++y)
      for (int z = 0; z < blocks.z; ++z) {
        made.blocks.push_back({x, y, z});
        for (int i = 0; i < static_cast<int>(MediumVoxels::kCells); ++i) {
          const glm::ivec3 cell = MediumVoxels::kSide * glm::ivec3(x, y, z) + glm::ivec3(i / 64, i / 8 % 8, i % 8);
          const bool inside = cell.x < size.x && cell.y < size.y && cell.z < size.z;
          made.density.push_back(inside ? density(cell) : 0.f);
        }
      }
  return made;
}

// S of leaves turned at random.
inline ProjectedArea randomArea(Random& random) {
  // A mean of three n n^T, made to one quarter of it as (R15) has it.
  float m[3][3] = {};
  for (int leaf = 0; leaf < 3; ++leaf) {
    float n[3], square = 0.f;
    for (float& c : n) {
      c = 2.f * random.uniform() - 1.f;
      square += c * c;
    }
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) m[i][j] += n[i] * n[j] / (3.f * square);
  }
  const auto entry = [&](int i, int j) {
    float squared = 0.f;
    for (int k = 0; k < 3; ++k) squared += m[i][k] * m[k][j];
    return (5.f * m[i][j] + 3.f * squared) / 8.f;
  };
  return {entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2)};
}

}  // namespace sunfleck::shapes
