#pragma once

#include "core/tree_mesh.hpp"
#include "plants/detail/stem.hpp"

namespace sunfleck::detail {

// Adds `count` leaves to one strand of a twig, from its base to its tip: the paper's rectangles, two triangles of four
// vertices of their own, with the middle of the base edge on the twig's axis.
void placeLeaves(const WeberPenn& parameters, const Bud& twig, const Strand& strand, int count, Random& random,
                 TreeMesh& mesh);

}  // namespace sunfleck::detail
