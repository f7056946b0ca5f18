#include "core/tree_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "core/require.hpp"

namespace sunfleck {
namespace {

constexpr float kLargestCoordinate = 1e4f;  // [m]; there a float still resolves a millimetre

void checkVertices(const TreeMesh& mesh, const std::string& source) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) {
      const float value = mesh.vertices[i][axis];
      if (!(std::abs(value) <= kLargestCoordinate))
        require(false, source + ": vertex " + std::to_string(i + 1) + " " + "xyz"[axis], value,
                "a finite number of metres, at most 1e4 in size");
    }
}

void checkIndices(const TreeMesh& mesh, const std::vector<glm::uvec3>& triangles, const std::string& what) {
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (int corner = 0; corner < 3; ++corner)
      if (triangles[i][corner] >= mesh.vertices.size())
        require(false, what + " triangle " + std::to_string(i + 1) + " vertex index", triangles[i][corner],
                "below the number of vertices, " + std::to_string(mesh.vertices.size()));
}

std::size_t dropFlat(const TreeMesh& mesh, std::vector<glm::uvec3>& triangles) {
  return std::erase_if(triangles, [&](const glm::uvec3& t) { return !(triangleArea(mesh, t) > 0.); });
}

// Union-find over vertices: `root` of two corners of a triangle is the same.
std::uint32_t rootOf(std::vector<std::uint32_t>& parent, std::uint32_t vertex) {
  while (parent[vertex] != vertex) vertex = parent[vertex] = parent[parent[vertex]];
  return vertex;
}

void groupConnectedLeaves(TreeMesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0u);
  for (const glm::uvec3& t : mesh.leaf_triangles)
    for (int corner = 1; corner < 3; ++corner) parent[rootOf(parent, t[corner])] = rootOf(parent, t[0]);

  constexpr std::uint32_t unnamed = ~0u;
  std::vector<std::uint32_t> leaf_of_root(mesh.vertices.size(), unnamed);
  mesh.leaf_of_triangle.clear();
  mesh.leaf_of_triangle.reserve(mesh.leaf_triangles.size());
  mesh.leaf_count = 0;
  for (const glm::uvec3& t : mesh.leaf_triangles) {
    std::uint32_t& leaf = leaf_of_root[rootOf(parent, t[0])];
    if (leaf == unnamed) leaf = mesh.leaf_count++;
    mesh.leaf_of_triangle.push_back(leaf);
  }
}

Bounds boundsOf(const TreeMesh& mesh, const std::vector<glm::uvec3>& triangles) {
  Bounds box;
  for (const glm::uvec3& t : triangles)
    for (int corner = 0; corner < 3; ++corner) box.include(mesh.vertices[t[corner]]);
  return box;
}

}  // namespace

Dropped finish(TreeMesh& mesh, const std::string& source) {
  checkVertices(mesh, source);
  checkIndices(mesh, mesh.leaf_triangles, source + ": leaf");
  checkIndices(mesh, mesh.wood_triangles, source + ": wood");
  const Dropped dropped{.leaf_triangles = dropFlat(mesh, mesh.leaf_triangles),
                        .wood_triangles = dropFlat(mesh, mesh.wood_triangles)};
  if (mesh.leaf_triangles.empty())
    throw InvalidInput(source + ": has no leaves (" + std::to_string(dropped.leaf_triangles) +
                       " leaf triangles of no area, " + std::to_string(mesh.wood_triangles.size()) +
                       " wood triangles): at least one leaf with an area is needed");
  groupConnectedLeaves(mesh);
  return dropped;
}

double triangleArea(const TreeMesh& mesh, const glm::uvec3& triangle) {
  const glm::dvec3 a = mesh.vertices[triangle.x];
  const glm::dvec3 b = mesh.vertices[triangle.y];
  const glm::dvec3 c = mesh.vertices[triangle.z];
  return 0.5 * glm::length(glm::cross(b - a, c - a));
}

std::vector<double> leafAreas(const TreeMesh& mesh) {
  std::vector<double> areas(mesh.leaf_count, 0.);
  for (std::size_t i = 0; i < mesh.leaf_triangles.size(); ++i)
    areas[mesh.leaf_of_triangle[i]] += triangleArea(mesh, mesh.leaf_triangles[i]);
  return areas;
}

double leafArea(const TreeMesh& mesh) {
  double area = 0.;
  for (const glm::uvec3& t : mesh.leaf_triangles) area += triangleArea(mesh, t);
  return area;
}

Bounds leafBounds(const TreeMesh& mesh) {
  return boundsOf(mesh, mesh.leaf_triangles);
}

Bounds bounds(const TreeMesh& mesh) {
  Bounds box = leafBounds(mesh);
  box.include(boundsOf(mesh, mesh.wood_triangles));
  return box;
}

}  // namespace sunfleck
