#pragma once

#include "core/tree_mesh.hpp"
#include "plants/detail/leaf_template.hpp"
#include "plants/detail/stem.hpp"

namespace sunfleck::detail {

// What the leaves of a tree are copies of.
struct LeafTemplates {
  explicit LeafTemplates(const WeberPenn& parameters);
  LeafTemplate leaf, blossom;

  // Of the leaf's triangles in turn: what the patches of a tree's leaves are numbers of. Blossoms show no images.
  std::vector<LeafPatch> patches() const;
};

// Adds `count` leaves to one strand of a twig, from its base to its tip, or as a fan at its tip: each with vertices of
// its own, numbered, without triangles of no area, and with its base, or the foot of its petiole, on the twig's axis.
void placeLeaves(const WeberPenn& parameters, const LeafTemplates& templates, const Bud& twig, const Strand& strand,
                 int count, Random& random, TreeMesh& mesh);

}  // namespace sunfleck::detail
