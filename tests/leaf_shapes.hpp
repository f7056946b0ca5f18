#pragma once

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <numbers>
#include <vector>

#include "core/directions.hpp"
#include "core/random.hpp"
#include "core/tree_mesh.hpp"

// Leaves of simple shapes for tests. The makers of meshes call `finish`.
namespace sunfleck::shapes {

// Adds a flat polygon as a fan of triangles.
inline void addPolygon(TreeMesh& mesh, std::vector<glm::uvec3>& triangles, const std::vector<glm::vec3>& corners) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
  for (std::uint32_t i = 2; i < corners.size(); ++i) triangles.push_back({first, first + i - 1, first + i});
}

inline std::vector<glm::vec3> rectangle(const glm::vec3& centre, const glm::vec3& half_a, const glm::vec3& half_b) {
  return {centre - half_a - half_b, centre + half_a - half_b, centre + half_a + half_b, centre - half_a + half_b};
}

// A regular 12-gon with the area of a disc of that radius [m].
inline std::vector<glm::vec3> disc(const glm::vec3& centre, const glm::vec3& normal, double radius) {
  constexpr int kSides = 12;
  const double pi = std::numbers::pi;
  const double outer = radius * std::sqrt(2. * pi / (kSides * std::sin(2. * pi / kSides)));
  const Axes axes = axesAlong(normal);
  std::vector<glm::vec3> corners;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2. * pi * i / kSides;
    corners.push_back(centre + static_cast<float>(outer * std::cos(angle)) * axes.right +
                      static_cast<float>(outer * std::sin(angle)) * axes.up);
  }
  return corners;
}

inline glm::vec3 onSphere(Random& random) {
  const float z = 2.f * random.uniform() - 1.f;
  const float angle = 2.f * std::numbers::pi_v<float> * random.uniform();
  const float r = std::sqrt(1.f - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

// `leaves` discs of radius 0.1 m, of random place and direction, in a box of 2 x 1 x 1 m about the origin.
inline TreeMesh leafBox(int leaves, std::uint64_t seed) {
  Random random(seed, 0);
  TreeMesh mesh;
  for (int i = 0; i < leaves; ++i) {
    const glm::vec3 centre(2.f * random.uniform() - 1.f, random.uniform() - 0.5f, random.uniform() - 0.5f);
    addPolygon(mesh, mesh.leaf_triangles, disc(centre, onSphere(random), 0.1));
  }
  finish(mesh, "leaf box");
  return mesh;
}

}  // namespace sunfleck::shapes
