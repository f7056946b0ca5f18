#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "core/stand.hpp"
#include "core/tree_mesh.hpp"

namespace sunfleck {

// Largest horizontal distance of a leaf's corner from the foot of the tree, about which it is turned [m].
float crownRadius(const TreeMesh& mesh);

// Trees of one kind on a rectangle about the origin. All throw InvalidInput on sizes that are not finite and > 0, and
// on more than 100,000 trees.

// In rows and columns `spacing` [m] apart, as many as fit, one at least; each then moved by up to `jitter` [1], 0 .. 1,
// of half the spacing along x and along y. With jitter 0 the stand is regular.
std::vector<Placement> gridStand(glm::vec2 size, float spacing, float jitter, std::uint64_t seed);

// Poisson discs: places at random, no two of them closer than `distance` [m], until hardly one more fits (R. Bridson
// 2007, "Fast Poisson Disk Sampling in Arbitrary Dimensions", 30 tries about each tree). With twice the crowns' radius
// as distance no crowns overlap.
std::vector<Placement> poissonStand(glm::vec2 size, float distance, std::uint64_t seed);

}  // namespace sunfleck
