#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/stand.hpp"
#include "core/tree_mesh.hpp"
#include "field/elements.hpp"

namespace sunfleck {

// (F1) The elements of all trees of a stand, as they stand: those of the leaves, tree after tree, come before those of
// the wood. The mesh's triangles stand in the order of their elements.
struct StandElements {
  TreeMesh mesh;                     // of all trees
  FieldElements elements;            // of it
  std::vector<std::uint32_t> kinds;  // of each element: 2 kind of leaves, 2 kind + 1 of wood
  // Of each tree, and one more: its first leaf, the first element of its leaves and of its wood.
  std::vector<std::size_t> first_leaf, first_element, first_wood;
};

// The elements of each kind that stands, which is all that follows from meshes alone; of others none.
std::vector<FieldElements> elementsOfKinds(std::span<const std::shared_ptr<const TreeMesh>> kinds, const Stand& stand,
                                           const ElementRule& rule = {});
StandElements standElements(std::span<const std::shared_ptr<const TreeMesh>> kinds,
                            std::span<const FieldElements> of_kinds, const Stand& stand);

}  // namespace sunfleck
