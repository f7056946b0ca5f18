#pragma once

#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/bounds.hpp"
#include "core/stand.hpp"
#include "core/tree_mesh.hpp"

namespace sunfleck::detail {

// A copy of a prototype: rotated about z, then moved.
struct Copy {
  std::uint32_t kind = 0;
  glm::vec3 translation{0.f};      // [m]
  float cosine = 1.f, sine = 0.f;  // of the rotation

  glm::vec3 rotated(const glm::vec3& v) const { return {cosine * v.x - sine * v.y, sine * v.x + cosine * v.y, v.z}; }
  // The point of the prototype that stands at this place.
  glm::vec3 inPrototype(const glm::vec3& place) const {
    const glm::vec3 v = place - translation;
    return {cosine * v.x + sine * v.y, cosine * v.y - sine * v.x, v.z};
  }
};

// Whether a single tree stands where its prototype does, as it is.
inline bool standsAsItIs(const std::vector<Copy>& copies) {
  const Copy& first = copies.front();
  return copies.size() == 1 && first.translation == glm::vec3(0.f) && first.sine == 0.f && first.cosine > 0.f;
}

// The copies rays can meet, in coordinates whose origin lies at `origin` of the stand's: near the middle, so that
// rounding does not depend on where in the world the stand stands. Nor does it on where its meshes have their origins:
// each prototype is taken about its pivot, a point near its middle from which its vertices differ without rounding.
struct StandCopies {
  glm::vec3 origin{0.f};          // [m]
  std::vector<glm::vec3> pivots;  // of each kind, in its mesh's coordinates [m]
  std::vector<Copy> copies;       // of the prototypes about their pivots
  Bounds box;                     // of all that can be hit, or of one period, about `origin` [m]
};

// The placements and, in a periodic stand, their copies shifted by whole periods as far as they reach into the period
// around the stand's middle. Throws InvalidInput as RayScene's constructor does.
//   others  box of what else can be met [m]; empty along an axis along which that has no end
StandCopies standCopies(std::span<const TreeMesh* const> kinds, const Stand& stand, bool with_wood,
                        const Bounds& others);

}  // namespace sunfleck::detail
