#pragma once

#include <span>
#include <vector>

#include "core/directions.hpp"
#include "core/leaf_optics.hpp"
#include "core/stand.hpp"
#include "core/tree_mesh.hpp"
#include "grid/leaf_depth.hpp"

namespace sunfleck {

// A yardstick for the field: the most that was found to come of the slab's solution for a tree without solving anything
// in 3-D. Light comes to a leaf along each of some directions from as many leaves as there are on its line to the edge
// of the foliage; each sends what a leaf at its depth in the leaf's slab would, of which the diffuse part is damped by
// the G of the leaf that receives. Direct light is that of the leaf itself. As if leaves were turned every way and
// reflected as much as they transmit.
class DampedLine {
 public:
  //   sun           in which its light travels
  //   slab          depth and thickness of each leaf along the sun's light
  //   compensation  G of each leaf [1]
  //   direct        irradiance of each leaf straight from the sun, both sides [1]
  DampedLine(const TreeMesh& mesh, const Stand& stand, Direction sun, LeafDepths slab, std::vector<float> compensation,
             std::vector<float> direct);

  // Irradiance of each leaf, both sides per one-sided area, for a sun of irradiance 1 [1].
  std::vector<float> irradiance(const LeafOptics& leaf) const;

 private:
  // Where light comes from, of each leaf.
  struct Way {
    float cosine;               // between the way out along it and that to the sun
    std::vector<float> leaves;  // met on the way to the edge of the foliage [1]
    std::vector<float> facing;  // |n.s| of the leaf that receives [1]
  };
  LeafDepths slab_;
  std::vector<float> compensation_, direct_;
  std::vector<Way> ways_;
};

}  // namespace sunfleck
