#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/progress.hpp"
#include "core/stand.hpp"
#include "grid/deep_opacity_map.hpp"

namespace sunfleck {

// Where each leaf sits in its equivalent slab, whose normal is the light's axis.
struct LeafDepths {
  std::vector<float> depth;      // d = n+: leaf crossings between the light and the leaf [1], >= 0
  std::vector<float> thickness;  // w = n+ + n- + 1, the leaf itself included [1], >= depth + 1
};

// A kind of tree and its map along a light.
struct LitKind {
  const TreeMesh* mesh;
  const DeepOpacityMap* light;
};

// (D6) Depth and thickness of each leaf of each tree of the stand, Eq. 29: crossing counts along the light's axis,
// averaged over the light rays (the map's pixels) that meet the leaf. A leaf that no pixel centre falls on is counted
// at its centre. Another tree's crossings are read in the pixel nearest to where they are. Rotations are not regarded.
// Throws InvalidInput as periodsAround() does, and std::runtime_error("interrupted") when `progress` ends it.
//   kinds  that the stand's trees are of, with maps along the same light
std::vector<LeafDepths> leafDepths(std::span<const LitKind> kinds, const Stand& stand, const Progress& progress = {});
// The same for one kind.
std::vector<LeafDepths> leafDepths(const TreeMesh& mesh, const DeepOpacityMap& light, const Stand& stand = {},
                                   const Progress& progress = {});

// Centre of area of each leaf [m].
std::vector<glm::vec3> leafCentres(const TreeMesh& mesh);

// |n.s| of each leaf for the direction s, averaged over its area [1], 0 .. 1.
std::vector<float> leafProjections(const TreeMesh& mesh, Direction direction);

}  // namespace sunfleck
