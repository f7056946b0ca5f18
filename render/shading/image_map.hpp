#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "core/tree_mesh.hpp"

namespace sunfleck::shading {

// Where the points of a leaf triangle lie in the images of its leaf: u = xyz . p + w, and v likewise.
struct ImageMap {
  glm::vec4 u{0.f}, v{0.f};  // xyz [1/m], w [1]; all 0 where that is not known
  bool known() const { return glm::vec3(u) != glm::vec3(0.f); }
  glm::vec2 at(const glm::vec3& place) const;  // in the prototype's frame [m]
};

ImageMap imageMap(const TreeMesh& mesh, std::size_t leaf_triangle);
// That of a piece which is its triangle, `larger` times as large about `from`, and moved so that this point lies at
// `to` [m].
ImageMap enlarged(const ImageMap& map, float larger, const glm::vec3& from, const glm::vec3& to);

}  // namespace sunfleck::shading
