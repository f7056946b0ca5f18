#include "plants/leaf_inclination.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace sunfleck {
namespace {

constexpr double kClass = std::numbers::pi / 18.;  // [rad]

}  // namespace

LeafInclination leafInclination(const TreeMesh& mesh) {
  LeafInclination found;
  double area = 0.;
  for (const glm::uvec3& t : mesh.leaf_triangles) {
    const glm::dvec3 a = mesh.vertices[t.x], b = mesh.vertices[t.y], c = mesh.vertices[t.z];
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double twice = glm::length(normal);
    const double angle = std::acos(std::min(1., std::abs(normal.z) / twice));
    found.shares[std::min<std::size_t>(8, static_cast<std::size_t>(angle / kClass))] += twice;
    found.mean_angle += twice * angle;
    area += twice;
  }
  if (area == 0.) return found;
  for (double& share : found.shares) share /= area;
  found.mean_angle /= area;
  return found;
}

std::array<double, 9> sphericalShares() {
  std::array<double, 9> shares;
  for (std::size_t i = 0; i < shares.size(); ++i)
    shares[i] = std::cos(static_cast<double>(i) * kClass) - std::cos(static_cast<double>(i + 1) * kClass);
  return shares;
}

}  // namespace sunfleck
