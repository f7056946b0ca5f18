#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/bounds.hpp"
#include "core/progress.hpp"
#include "field/cell_medium.hpp"
#include "field/leaf_clusters.hpp"

namespace sunfleck {

// The clusters of a kind as they lie in a tree that is turned about the vertical, relative to its place.
struct TurnedClusters {
  const LeafClusters* clusters = nullptr;
  std::vector<glm::vec3> centre;  // [m]
  std::vector<glm::vec3> normal;  // of the front, or of the back where that is what faces along an axis
  std::vector<Facing> facing;     // which axis, and whether the front faces against it
};
TurnedClusters turnedClusters(const LeafClusters& clusters, float rotation);

// A tree of a stand of very many.
struct ClusteredTree {
  const TurnedClusters* turned = nullptr;
  glm::vec3 position{0.f};  // [m]
  std::uint32_t kind = 0;
};

// (F28) The medium of a stand of very many trees: in each cell one element for each kind and each way to face, leaves
// apart from wood, each with one piece of its own number.
struct StandMedium {
  CellMedium cells;
  std::vector<std::uint8_t> axis;  // that each element faces
};

//   box     about all trees, whose lowest side is the ground's [m]
//   side    of the cells, with a period and in height as near as whole numbers of them come to it [m]
// Throws InvalidInput where cells take more memory than there is, and std::runtime_error("interrupted") when
// `progress`, told after each tree, ends it.
StandMedium standMedium(std::span<const ClusteredTree> trees, const Bounds& box, float side,
                        const std::optional<glm::vec2>& period, const Progress& progress = {});

// The cell that a point lies in, the nearest where it is rounded out of the grid; in a grid that repeats whole periods
// are not taken off.
glm::ivec3 cellAt(const SweepGrid& grid, const glm::vec3& point);
// Its number in the grid.
std::uint32_t cellNumber(const SweepGrid& grid, glm::ivec3 cell);

// Of each cluster of a tree twice the element that it is part of, and 1 more where its front is the element's back.
std::vector<std::uint32_t> elementSides(const StandMedium& medium, const CellMedium& cells, const ClusteredTree& tree);

}  // namespace sunfleck
