#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "core/stand.hpp"
#include "render/gl/sun_map.hpp"

namespace sunfleck::gl {

// A tree whose leaves may stand in another's light.
struct Neighbour {
  glm::vec3 displacement;  // from the tree in question [m]
  std::uint32_t tree;      // of the stand
};

// One drawn tree, or the ground.
struct Instance {
  glm::vec3 position{0.f};                                // [m]
  std::uint32_t tree = 0;                                 // of the stand
  std::uint32_t first_neighbour = 0, neighbours_end = 0;  // in StandInstances::neighbours
};

// (R4) Who is drawn, and who may shade whom: two trees share light when the pictures of their boxes along the sun
// overlap (Eq. 31's neighbour lists). A periodic stand is drawn with one ring of copies around it; light is shared over
// `periods_around` periods in x and y.
struct StandInstances {
  std::vector<Instance> drawn;        // trees of the stand first
  Instance ground;                    // its neighbours: all trees whose shadow may fall on the disc
  std::vector<Neighbour> neighbours;  // the first of each drawn tree is that tree itself, displaced by 0
};

// The ground's disc [m].
struct GroundDisc {
  glm::vec3 centre{0.f};
  float radius = 0.f;
};

// Rotations are ignored: a map along the sun is a rotated tree's own only when the sun turns with the tree.
StandInstances standInstances(const Stand& stand, glm::ivec2 periods_around, const SunMap& map,
                              const GroundDisc& ground);

}  // namespace sunfleck::gl
