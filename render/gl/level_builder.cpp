#include "render/gl/detail/level_builder.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include "core/morton_order.hpp"

namespace sunfleck::gl::detail {
namespace {

constexpr std::size_t kClusterTriangles = 64;

TriangleData dataOf(const LevelTriangle& triangle) {
  const glm::dvec3 a = triangle.corners[0], b = triangle.corners[1], c = triangle.corners[2];
  const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
  return {.plane = glm::vec4(glm::vec3(normal) * triangle.enlargement,
                             static_cast<float>(glm::dot(normal, (a + b + c) / 3.))),
          .middle = triangle.middle,
          .leaf = triangle.leaf};
}

}  // namespace

void LevelBuilder::add(std::vector<Level>& into, const std::vector<LevelTriangle>& triangles, std::size_t shared_count,
                       float piece_area) {
  constexpr std::uint32_t none = ~0u;
  const auto first = static_cast<std::uint32_t>(levels_.triangles.size());
  const auto count = static_cast<std::uint32_t>(triangles.size());
  // Each triangle owns the vertex of its number; where it can, one of a corner that others share.
  std::vector<std::uint32_t> vertex_of(shared_count, none);
  std::vector<std::size_t> own(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const LevelTriangle& triangle = triangles[i];
    for (std::size_t corner = 0; corner < 3; ++corner)
      if (vertex_of[triangle.shared[corner]] == none) {
        own[i] = corner;
        vertex_of[triangle.shared[corner]] = first + i;
        break;
      }
    owned_.push_back(triangle.corners[own[i]]);
    levels_.triangles.push_back(dataOf(triangle));
    levels_.sources.push_back(triangle.source);
  }
  const auto vertexAt = [&](const LevelTriangle& triangle, std::size_t corner) {
    std::uint32_t& vertex = vertex_of[triangle.shared[corner]];
    if (vertex == none) {
      vertex = kExtra + static_cast<std::uint32_t>(extra_.size());
      extra_.push_back(triangle.corners[corner]);
    }
    return vertex;
  };

  Bounds box;
  for (const LevelTriangle& triangle : triangles)
    for (const glm::vec3& corner : triangle.corners) box.include(corner);
  levels_.box.include(box);
  std::vector<glm::vec3> places;
  places.reserve(count);
  for (const LevelTriangle& triangle : triangles) places.push_back(triangle.corners[0]);
  const std::vector<std::uint32_t> order = mortonOrder(places);
  Level& level = into.emplace_back();
  level.piece_area = piece_area;
  for (std::size_t i = 0; i < count; ++i) {
    if (i % kClusterTriangles == 0)
      level.clusters.push_back({.first_index = static_cast<std::uint32_t>(levels_.indices.size()), .box = {}});
    const LevelTriangle& triangle = triangles[order[i]];
    const std::size_t last = own[order[i]];
    for (const std::size_t corner : {(last + 1) % 3, (last + 2) % 3})
      levels_.indices.push_back(vertexAt(triangle, corner));
    levels_.indices.push_back(first + order[i]);
    for (const glm::vec3& corner : triangle.corners) level.clusters.back().box.include(corner);
    level.clusters.back().end_index = static_cast<std::uint32_t>(levels_.indices.size());
  }
}

void LevelBuilder::finish() {
  levels_.vertices = std::move(owned_);
  for (std::uint32_t& index : levels_.indices)
    if (index >= kExtra) index = index - kExtra + static_cast<std::uint32_t>(levels_.vertices.size());
  levels_.vertices.insert(levels_.vertices.end(), extra_.begin(), extra_.end());
}

}  // namespace sunfleck::gl::detail
