#pragma once

#include "core/tree_mesh.hpp"
#include "plants/detail/stem.hpp"

namespace sunfleck::detail {

// Adds a strand of a stem to the wood: a ring of vertices at every station and a closed tip. The trunk gets its flare
// and lobes.
void addTube(const WeberPenn& parameters, const Bud& bud, const Strand& strand, TreeMesh& mesh);

}  // namespace sunfleck::detail
