#include "plants/detail/leaf_placement.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "plants/detail/budding.hpp"

namespace sunfleck::detail {
namespace {

// Weber & Penn's leaf orientation: turn the leaf's face by the share `bend` outward, about the vertical, and then up.
void bendToLight(Frame& leaf, double bend) {
  const glm::dvec3 vertical(0., 0., 1.);
  const glm::dvec3 face = leaf.up();
  const double outward = std::atan2(leaf.position.y, leaf.position.x) - std::atan2(face.y, face.x);
  leaf.turn(vertical, bend * std::remainder(outward, 2. * std::numbers::pi));
  const glm::dvec3 turned = leaf.up();
  const glm::dvec3 axis = glm::cross(turned, vertical);
  if (glm::length(axis) > 1e-6)
    leaf.turn(glm::normalize(axis), bend * std::atan2(std::hypot(turned.x, turned.y), turned.z));
}

void addLeaf(const WeberPenn& parameters, const Frame& leaf, TreeMesh& mesh) {
  const glm::dvec3 length = double{parameters.leaf_scale} * leaf.along;
  const glm::dvec3 half_width = 0.5 * double{parameters.leaf_scale} * double{parameters.leaf_scale_x} * leaf.right;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.emplace_back(leaf.position - half_width);
  mesh.vertices.emplace_back(leaf.position + half_width);
  mesh.vertices.emplace_back(leaf.position + length + half_width);
  mesh.vertices.emplace_back(leaf.position + length - half_width);
  mesh.leaf_triangles.push_back({first, first + 1, first + 2});
  mesh.leaf_triangles.push_back({first, first + 2, first + 3});
}

}  // namespace

void placeLeaves(const WeberPenn& parameters, const Bud& twig, const Strand& strand, int count, Random& random,
                 TreeMesh& mesh) {
  const WeberPenn::Level& level = parameters.level[static_cast<std::size_t>(std::min(parameters.levels, 3))];
  const WeberPenn::Level& stem = parameters.level[static_cast<std::size_t>(twig.level)];
  const double bare = std::max(double{stem.base_size} * twig.length, strand.front().distance);
  Phyllotaxis phyllotaxis(level, random);
  for (int i = 1; i <= count; ++i) {
    const double share = double(i) / count;
    Frame leaf = frameAt(strand, bare + share * (twig.length - bare));
    phyllotaxis.direct(leaf, downAngle(level, 1. - share, random), random);
    bendToLight(leaf, double{parameters.leaf_bend});
    addLeaf(parameters, leaf, mesh);
  }
}

}  // namespace sunfleck::detail
