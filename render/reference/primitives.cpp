#include "render/reference/detail/primitives.hpp"

#include <optional>

#include "render/reference/detail/scene_geometry.hpp"

namespace sunfleck {
namespace detail {
namespace {

// Of the triangles, in pairs: below that a quad's second, empty triangle costs more than pairs save.
constexpr double kLeastPaired = 0.8;

// The corners 0 1 2 3 of the quad.
std::optional<std::array<std::uint32_t, 4>> quadOf(const glm::uvec3& a, const glm::uvec3& b) {
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t first = a[(i + 1) % 3], third = a[(i + 2) % 3];
      if (b[(k + 1) % 3] == third && b[(k + 2) % 3] == first && a[i] != b[k])
        return std::array{a[i], first, b[k], third};
    }
  return std::nullopt;
}

}  // namespace

Primitives alone(std::span<const glm::uvec3> triangles) {
  Primitives primitives;
  for (const glm::uvec3& triangle : triangles) {
    primitives.first_triangle.push_back(static_cast<std::uint32_t>(primitives.first_triangle.size()));
    for (int i = 0; i < 3; ++i) primitives.corners.push_back(triangle[i]);
  }
  return primitives;
}

Primitives paired(std::span<const glm::uvec3> triangles, std::span<const std::uint32_t> leaf) {
  Primitives primitives{.each = 4, .corners = {}, .first_triangle = {}};
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    primitives.first_triangle.push_back(static_cast<std::uint32_t>(i));
    const bool may_pair = i + 1 < triangles.size() && (leaf.empty() || leaf[i] == leaf[i + 1]);
    const auto quad = may_pair ? quadOf(triangles[i], triangles[i + 1]) : std::nullopt;
    const glm::uvec3& t = triangles[i];
    for (const std::uint32_t corner : quad.value_or(std::array{t.x, t.y, t.z, t.z}))
      primitives.corners.push_back(corner);
    if (quad) ++i;
  }
  const double in_pairs = 2. * static_cast<double>(triangles.size() - primitives.first_triangle.size());
  return in_pairs >= kLeastPaired * static_cast<double>(triangles.size()) ? primitives : alone(triangles);
}

}  // namespace detail

using namespace detail;

const glm::vec3* detail::verticesOf(RTCScene scene, unsigned number) {
  return static_cast<const glm::vec3*>(
      rtcGetGeometryBufferData(rtcGetGeometry(scene, number), RTC_BUFFER_TYPE_VERTEX, 0));
}

std::vector<Facet> RayScene::Geometry::facets(std::uint32_t kind) const {
  std::vector<Facet> facets;
  const Prototype& prototype = prototypes[kind];
  const std::size_t leaves = prototype.leaf_of_primitive.size();
  for (const unsigned number : {kLeaves, kWood}) {
    const std::size_t count = number == kLeaves ? leaves : prototype.planes.size() - leaves;
    if (count == 0) continue;
    const RTCGeometry geometry = rtcGetGeometry(scenes.prototypes[kind].get(), number);
    const glm::vec3* vertices = verticesOf(scenes.prototypes[kind].get(), number);
    const auto* corners =
        static_cast<const std::uint32_t*>(rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_INDEX, 0));
    const std::size_t each = (number == kLeaves ? prototype.leaf_quads : prototype.wood_quads) ? 4 : 3;
    const auto at = [&](std::uint32_t vertex) { return glm::dvec3(vertices[vertex]); };
    for (std::uint32_t i = 0; i < count; ++i, corners += each) {
      const glm::dvec3 zero = at(corners[0]), one = at(corners[1]), last = at(corners[each - 1]);
      const bool pair = each == 4 && corners[2] != corners[3];
      Facet facet{.corner = zero, .first = one - zero, .second = last - zero, .primitive = i, .wood = number == kWood};
      const glm::dvec3 two = pair ? at(corners[2]) : glm::dvec3(0.);
      facet.parallelogram = pair && glm::length(zero + two - one - last) <= double{lift};
      facets.push_back(facet);
      if (!pair || facet.parallelogram) continue;
      facet.corner = two;
      facet.first = last - two;
      facet.second = one - two;
      facets.push_back(facet);
    }
  }
  return facets;
}

}  // namespace sunfleck
