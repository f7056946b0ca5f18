#include <algorithm>
#include <glm/geometric.hpp>

#include "render/reference/detail/scene_geometry.hpp"

namespace sunfleck {
using namespace detail;
namespace {

// Whether a point of two triangles with an edge in common lies on the second: beyond the plane through that edge that
// parts them evenly, so that folded ones are told apart as well.
//   across  sum of their unit normals
bool onSecond(const LeafImages& images, std::uint32_t first, const glm::vec3& across, const glm::vec3& at) {
  const glm::uvec3 &a = images.triangles[first], &b = images.triangles[first + 1];
  int apart = 0;  // the first's corner that the second has not
  while (apart < 2 && (a[apart] == b.x || a[apart] == b.y || a[apart] == b.z)) ++apart;
  const glm::vec3 from = images.vertices[a[(apart + 1) % 3]], to = images.vertices[a[(apart + 2) % 3]];
  return glm::dot(glm::cross(across, to - from), at - from) < 0.f;
}

}  // namespace

std::optional<glm::vec2> RayScene::Geometry::inImages(const Hit& hit) const {
  const Copy& copy = copies[hit.copy];
  const Prototype& prototype = prototypes[copy.kind];
  if (!prototype.images) return std::nullopt;
  const LeafImages& images = *prototype.images;
  const glm::vec3 at = scenes.instances ? copy.inPrototype(hit.position) : hit.position;
  const std::size_t next = hit.primitive + std::size_t{1};
  std::uint32_t triangle = prototype.first_triangle[hit.primitive];
  const std::size_t end =
      next < prototype.leaf_of_primitive.size() ? prototype.first_triangle[next] : images.triangles.size();
  const std::array<glm::vec4, 2>& planes = prototype.planes[hit.primitive];
  if (end - triangle > 1 && onSecond(images, triangle, glm::vec3(planes[0]) + glm::vec3(planes[1]), at)) ++triangle;
  const std::uint32_t number = images.patch_of_triangle[triangle];
  if (number == TreeMesh::kNoPatch) return std::nullopt;

  const glm::uvec3& corners = images.triangles[triangle];
  const glm::dvec3 a = images.vertices[corners.x];
  const glm::dvec3 b = glm::dvec3(images.vertices[corners.y]) - a, c = glm::dvec3(images.vertices[corners.z]) - a;
  const glm::dvec3 normal = glm::cross(b, c), from = glm::dvec3(at) - a;
  const double area = glm::dot(normal, normal);
  // Rounding leaves a point beside a triangle, by far more than its width where that is next to none.
  const double u = std::clamp(glm::dot(glm::cross(from, c), normal) / area, 0., 1.);
  const double v = std::clamp(glm::dot(glm::cross(b, from), normal) / area, 0., 1. - u);
  const ImageCorners& shown = images.patches[number].corners;
  return glm::vec2((1. - u - v) * glm::dvec2(shown[0]) + u * glm::dvec2(shown[1]) + v * glm::dvec2(shown[2]));
}

}  // namespace sunfleck
