#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/tree_mesh.hpp"

namespace sunfleck {

// Square leaves at random places with random orientations (spherical leaf angles): the medium that scattering theory
// assumes, for checking theory and code where the answer is known.

// Leaves in a box that is meant to repeat without end in x and y; it starts at the origin.
struct RandomLayer {
  glm::vec2 size{2.f, 2.f};     // sides of the repeated rectangle [m], > 0
  float height = 2.f;           // [m], > 0
  float leaf_side = 0.05f;      // [m], > 0
  float leaf_area_index = 6.f;  // one-sided leaf area over ground area [1], > 0
};
TreeMesh randomLayer(const RandomLayer& layer, std::uint64_t seed);

// Leaves in an ellipsoid about the origin.
struct RandomCrown {
  glm::vec3 size{2.f, 2.f, 3.f};  // full axes [m], > 0
  float leaf_side = 0.05f;        // [m], > 0
  int leaves = 9000;              // > 0
};
TreeMesh randomCrown(const RandomCrown& crown, std::uint64_t seed);

}  // namespace sunfleck
