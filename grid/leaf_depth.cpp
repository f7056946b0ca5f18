#include "grid/leaf_depth.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "grid/neighbours.hpp"

namespace sunfleck {

std::vector<glm::vec3> leafCentres(const TreeMesh& mesh) {
  std::vector<glm::dvec3> weighted(mesh.leaf_count, glm::dvec3(0.));
  for (std::size_t i = 0; i < mesh.leaf_triangles.size(); ++i) {
    const glm::uvec3& t = mesh.leaf_triangles[i];
    const glm::dvec3 corners =
        glm::dvec3(mesh.vertices[t.x]) + glm::dvec3(mesh.vertices[t.y]) + glm::dvec3(mesh.vertices[t.z]);
    weighted[mesh.leaf_of_triangle[i]] += triangleArea(mesh, t) / 3. * corners;
  }
  const std::vector<double> areas = leafAreas(mesh);
  std::vector<glm::vec3> centres;
  centres.reserve(mesh.leaf_count);
  for (std::size_t leaf = 0; leaf < mesh.leaf_count; ++leaf) centres.emplace_back(weighted[leaf] / areas[leaf]);
  return centres;
}

std::vector<float> leafProjections(const TreeMesh& mesh, Direction direction) {
  std::vector<double> projected(mesh.leaf_count, 0.);
  for (std::size_t i = 0; i < mesh.leaf_triangles.size(); ++i) {
    const glm::uvec3& t = mesh.leaf_triangles[i];
    const glm::dvec3 a = mesh.vertices[t.x], b = mesh.vertices[t.y], c = mesh.vertices[t.z];
    projected[mesh.leaf_of_triangle[i]] += 0.5 * std::abs(glm::dot(glm::cross(b - a, c - a), glm::dvec3(direction)));
  }
  const std::vector<double> areas = leafAreas(mesh);
  std::vector<float> projections;
  projections.reserve(mesh.leaf_count);
  for (std::size_t leaf = 0; leaf < mesh.leaf_count; ++leaf)
    projections.push_back(static_cast<float>(std::min(1., projected[leaf] / areas[leaf])));
  return projections;
}

LeafDepths leafDepths(const TreeMesh& mesh, const DeepOpacityMap& light, std::span<const glm::vec3> neighbours) {
  const std::vector<glm::vec3> met = neighboursAlong(neighbours, leafBounds(mesh), light.along(), true);
  struct Sums {
    double before = 0., beyond = 0., rays = 0.;
  };
  std::vector<Sums> sums(mesh.leaf_count);
  const auto add = [&](std::uint32_t leaf, glm::vec3 point, int before, int beyond) {
    for (const glm::vec3& t : met) {
      const DeepOpacityMap::Counts more = light.counts(point - t);
      before += more.before;
      beyond += more.beyond;
    }
    sums[leaf].before += before;
    sums[leaf].beyond += beyond;
    sums[leaf].rays += 1.;
  };
  for (int y = 0; y < light.size().y; ++y)
    for (int x = 0; x < light.size().x; ++x) {
      const std::span<const Crossing> line = light.crossings(x, y);
      for (const Crossing& here : line) {
        int before = 0, beyond = 0;
        for (const Crossing& other : line)  // a folded leaf does not stand in its own light
          if (other.leaf != here.leaf) ++(other.depth < here.depth ? before : beyond);
        add(here.leaf, light.inSpace(x, y, here.depth), before, beyond);
      }
    }
  const std::vector<glm::vec3> centres = leafCentres(mesh);
  LeafDepths result;
  result.depth.reserve(mesh.leaf_count);
  result.thickness.reserve(mesh.leaf_count);
  for (std::uint32_t leaf = 0; leaf < mesh.leaf_count; ++leaf) {
    if (sums[leaf].rays == 0.) {
      const DeepOpacityMap::Counts at_centre = light.counts(centres[leaf], leaf);
      add(leaf, centres[leaf], at_centre.before, at_centre.beyond);
    }
    const Sums& s = sums[leaf];
    result.depth.push_back(static_cast<float>(s.before / s.rays));
    result.thickness.push_back(static_cast<float>((s.before + s.beyond) / s.rays + 1.));
  }
  return result;
}

}  // namespace sunfleck
