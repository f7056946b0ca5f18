#pragma once

#include <array>
#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/bounds.hpp"

namespace sunfleck {

// Leaves whose normals lie at one angle to the vertical, turned every way about it.
struct LeafRing {
  float cosine = 1.f;  // of the inclination [1], 0 .. 1
  float weight = 1.f;  // share of the leaf area [1]
};

// (R15) S of leaves of leaf area 1: they are seen along the unit vector d as the area sqrt(d.S d), 0 .. 1. A multiple
// of the unit matrix by 1/4: leaves of all directions alike.
struct ProjectedArea {
  float xx = 0.25f, yy = 0.25f, zz = 0.25f, xy = 0.f, xz = 0.f, yz = 0.f;
};

// What fills space in cubic cells, in blocks of 8 x 8 x 8 of them; cell (x, y, z) of a block is number 64 x + 8 y + z.
struct MediumVoxels {
  static constexpr int kSide = 8;
  static constexpr std::size_t kCells = 512;

  glm::vec3 corner{0.f};              // of cell (0, 0, 0) of block (0, 0, 0), in the stand's coordinates [m]
  float cell_size = 1.f;              // [m]
  std::vector<glm::ivec3> blocks;     // places of the blocks that hold something, each at most once [block]
  std::vector<float> density;         // of each block's cells [1/m]: see TraceMedium
  std::vector<ProjectedArea> leaves;  // likewise, how leaves are turned in each cell; or none
};

// (R14) What scatters light in space and not on surfaces: turbid leaves, so small that there is no end of them, or
// particles. Several media may fill the same space.
struct TraceMedium {
  enum class Scatterer { leaves, particles };

  Scatterer scatterer = Scatterer::leaves;
  float asymmetry = 0.f;        // of particles: g of Henyey and Greenstein [1], -1 < g < 1
  std::vector<LeafRing> rings;  // of leaves: how they are inclined; none: to all directions alike
  // Where it is the same everywhere: in a box, which may be without end along x and y, from -infinity to infinity,
  // where the stand is periodic. In the stand's coordinates [m].
  Bounds box{};
  float density = 0.f;  // one-sided leaf area, or extinction by particles, per volume [1/m], >= 0
  // Otherwise, instead of both; or cut to the box, where it is not empty: a cell that is cut keeps what it holds.
  std::optional<MediumVoxels> voxels{};
};

// Box of all cells with something in them, as far as they are not cut off, or of a homogeneous medium [m].
Bounds occupied(const TraceMedium& medium);

// Throws InvalidInput on a value out of its range, a medium that is nowhere, rings whose weights do not sum to 1, a box
// without end in a stand without period, and one that is wider than the period, voxels but for a part of a cell.
void validate(const TraceMedium& medium, const std::optional<glm::vec2>& period);

// Tells media apart: all their bits, hashed; empty without any.
std::string mediaHash(const std::vector<TraceMedium>& media);

}  // namespace sunfleck
