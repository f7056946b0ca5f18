#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "field/elements.hpp"

namespace sunfleck {

// The way a leaf faces, one of six axes spread evenly, so that none is more than 38 degrees off; light meets either
// side of a leaf alike, so that leaves that face against an axis are counted with it, their sides exchanged.
inline constexpr std::size_t kFacings = 6;
struct Facing {
  std::uint8_t axis = 0;  // 0 .. kFacings - 1
  bool against = false;   // whether the front faces against it
};
Facing facingOf(const glm::vec3& normal);

// (F28) Elements of a tree gathered by the cells they lie in, by the way they face, and leaves apart from wood: what
// stands for them where a tree is one of very many.
struct LeafClusters {
  std::vector<glm::vec3> centre;       // mean over the area [m]
  std::vector<glm::vec3> normal;       // of the front; the mean over the area, a unit vector
  std::vector<float> area;             // seen from either side [m^2]: of wood half of its surface
  std::vector<std::uint8_t> wood;      // whether it is wood
  std::vector<std::uint8_t> facing;    // the axis along which it faces
  std::vector<glm::ivec3> cell;        // that it lies in
  std::vector<std::uint32_t> of_side;  // of each side of each element: 2 cluster (front) or 2 cluster + 1 (back)
  std::size_t size() const { return area.size(); }
};

//   side  of the cells [m], > 0; their corners lie at whole multiples of it
LeafClusters leafClusters(const FieldElements& elements, float side);

// Clusters gathered further, of so many cells along each axis.
struct ClusterGroups {
  std::vector<std::uint32_t> of_cluster;
  std::size_t count = 0;
};
ClusterGroups clusterGroups(const LeafClusters& clusters, int cells);

// Cells of a side that the elements' centres lie in.
std::size_t cellsTaken(const FieldElements& elements, float side);

}  // namespace sunfleck
