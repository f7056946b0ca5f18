#include "core/finished_mesh.hpp"

#include <cmath>
#include <limits>

#include "core/require.hpp"

namespace sunfleck {
namespace {

constexpr float kLargestCoordinate = 1e4f;  // [m]; there a float still resolves a millimetre

void requireAreas(const TreeMesh& mesh, const std::vector<glm::uvec3>& triangles, const std::string& what) {
  for (std::size_t i = 0; i < triangles.size(); ++i)
    if (const double area = triangleArea(mesh, triangles[i]); !hasArea(area))
      require(false, what + " triangle " + std::to_string(i + 1) + " area", area, "above 0 (finish() drops it)");
}

}  // namespace

void requireVertices(const TreeMesh& mesh, const std::string& source) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) {
      const float value = mesh.vertices[i][axis];
      if (!(std::abs(value) <= kLargestCoordinate))
        require(false, source + ": vertex " + std::to_string(i + 1) + " " + "xyz"[axis], value,
                "a finite number of metres, at most 1e4 in size");
    }
}

void requireIndices(const TreeMesh& mesh, const std::vector<glm::uvec3>& triangles, const std::string& what) {
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (int corner = 0; corner < 3; ++corner)
      if (triangles[i][corner] >= mesh.vertices.size())
        require(false, what + " triangle " + std::to_string(i + 1) + " vertex index", triangles[i][corner],
                "below the number of vertices, " + std::to_string(mesh.vertices.size()));
}

bool hasArea(double area) {
  return area >= double{std::numeric_limits<float>::min()};
}

void requireFinished(const TreeMesh& mesh, const std::string& source) {
  require(mesh.leaf_count > 0, source + ": number of leaves", mesh.leaf_count, "at least 1");
  require(mesh.leaf_of_triangle.size() == mesh.leaf_triangles.size(), source + ": leaf triangles told to be of a leaf",
          mesh.leaf_of_triangle.size(), "all of them (finish() tells)");
  for (const std::uint32_t leaf : mesh.leaf_of_triangle)
    if (leaf >= mesh.leaf_count) require(false, source + ": leaf of a triangle", leaf, "below the number of leaves");
  requireVertices(mesh, source);
  requireIndices(mesh, mesh.leaf_triangles, source + ": leaf");
  requireIndices(mesh, mesh.wood_triangles, source + ": wood");
  requireAreas(mesh, mesh.leaf_triangles, source + ": leaf");
  requireAreas(mesh, mesh.wood_triangles, source + ": wood");
}

}  // namespace sunfleck
