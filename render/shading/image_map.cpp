#include "render/shading/image_map.hpp"

#include <glm/geometric.hpp>

namespace sunfleck::shading {

glm::vec2 ImageMap::at(const glm::vec3& place) const {
  return {glm::dot(glm::vec3(u), place) + u.w, glm::dot(glm::vec3(v), place) + v.w};
}

ImageMap imageMap(const TreeMesh& mesh, std::size_t leaf_triangle) {
  const LeafPatch* patch = patchOf(mesh, leaf_triangle);
  if (!patch) return {};
  const glm::uvec3& corners = mesh.leaf_triangles[leaf_triangle];
  const glm::dvec3 a = mesh.vertices[corners.x];
  const glm::dvec3 b = glm::dvec3(mesh.vertices[corners.y]) - a, c = glm::dvec3(mesh.vertices[corners.z]) - a;
  const glm::dvec3 normal = glm::cross(b, c);
  const double square = glm::dot(normal, normal);
  // Weights of the second and third corner have these gradients.
  const glm::dvec3 second = glm::cross(c, normal) / square, third = glm::cross(normal, b) / square;
  ImageMap map;
  for (int axis = 0; axis < 2; ++axis) {
    const double at_a = double{patch->corners[0][axis]};
    const glm::dvec3 gradient =
        (double{patch->corners[1][axis]} - at_a) * second + (double{patch->corners[2][axis]} - at_a) * third;
    (axis == 0 ? map.u : map.v) = glm::vec4(glm::dvec4(gradient, at_a - glm::dot(gradient, a)));
  }
  return map;
}

ImageMap enlarged(const ImageMap& map, float larger, const glm::vec3& from, const glm::vec3& to) {
  ImageMap result;
  const glm::vec2 middle = map.at(from);
  for (const auto axis : {&ImageMap::u, &ImageMap::v}) {
    const glm::vec3 gradient = glm::vec3(map.*axis) / larger;
    result.*axis = glm::vec4(gradient, (axis == &ImageMap::u ? middle.x : middle.y) - glm::dot(gradient, to));
  }
  return result;
}

}  // namespace sunfleck::shading
