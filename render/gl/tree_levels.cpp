#include "render/gl/tree_levels.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>

#include "core/random.hpp"
#include "render/gl/detail/level_builder.hpp"
#include "render/gl/detail/simple_wood.hpp"
#include "render/gl/detail/thinning.hpp"

namespace sunfleck::gl {
namespace {

using namespace detail;

constexpr double kFewestLeaves = 32., kFewestTriangles = 200.;
constexpr float kFinestReach = 0.002f;  // [m], of simplified wood
constexpr float kFineReach = 0.015f;    // up to here levels, which are much work and serve only close by, are few [m]
constexpr double kStep = std::numbers::sqrt2;  // from a level's area of a piece to the next one's
constexpr std::uint64_t kSeed = 33;
constexpr float kReachesSquared = 8.f;  // area of a piece of wood by the square of the reach

std::vector<glm::vec3> middlesOf(const TreeMesh& mesh, const std::vector<double>& areas) {
  std::vector<glm::dvec3> sums(mesh.leaf_count);
  for (std::size_t t = 0; t < mesh.leaf_triangles.size(); ++t) {
    const glm::uvec3& corners = mesh.leaf_triangles[t];
    sums[mesh.leaf_of_triangle[t]] += triangleArea(mesh, corners) / 3. *
                                      (glm::dvec3(mesh.vertices[corners.x]) + glm::dvec3(mesh.vertices[corners.y]) +
                                       glm::dvec3(mesh.vertices[corners.z]));
  }
  std::vector<glm::vec3> middles;
  for (std::size_t leaf = 0; leaf < sums.size(); ++leaf) middles.push_back(sums[leaf] / std::max(areas[leaf], 1e-300));
  return middles;
}

// Of each leaf one triangle, drawn at random in proportion to area, the same each time.
std::vector<std::size_t> oneTriangleOfEach(const TreeMesh& mesh, const std::vector<double>& areas) {
  std::vector<double> left(areas);
  for (std::size_t leaf = 0; leaf < left.size(); ++leaf) left[leaf] *= Random(kSeed, leaf).uniformDouble();
  std::vector<std::size_t> chosen(areas.size());
  for (std::size_t t = 0; t < mesh.leaf_triangles.size(); ++t) {
    const std::uint32_t leaf = mesh.leaf_of_triangle[t];
    const double area = triangleArea(mesh, mesh.leaf_triangles[t]);
    if (left[leaf] >= 0. && area > 0.) chosen[leaf] = t;
    left[leaf] -= area;
  }
  return chosen;
}

LevelTriangle asItIs(const TreeMesh& mesh, const glm::uvec3& triangle, std::size_t source) {
  LevelTriangle result{.source = static_cast<std::uint32_t>(source)};
  for (std::size_t corner = 0; corner < 3; ++corner) {
    result.shared[corner] = triangle[static_cast<int>(corner)];
    result.corners[corner] = mesh.vertices[result.shared[corner]];
  }
  return result;
}

}  // namespace

TreeLevels treeLevels(const TreeMesh& mesh) {
  TreeLevels levels;
  LevelBuilder builder(levels);
  const std::vector<double> areas = leafAreas(mesh);
  const std::vector<glm::vec3> middles = middlesOf(mesh, areas);
  const std::vector<float> rank = ranks(areas.size());
  const std::vector<std::size_t> one_triangle = oneTriangleOfEach(mesh, areas);
  const auto addLeaves = [&](double piece_area) {
    const std::vector<float> enlargement = thinned(areas, rank, piece_area);
    std::vector<LevelTriangle> triangles;
    for (std::size_t t = 0; t < mesh.leaf_triangles.size(); ++t) {
      const std::uint32_t leaf = mesh.leaf_of_triangle[t];
      if (enlargement[leaf] == 0.f) continue;
      const bool enlarged = enlargement[leaf] != 1.f;
      if (enlarged && t != one_triangle[leaf]) continue;
      LevelTriangle triangle = asItIs(mesh, mesh.leaf_triangles[t], t);
      if (enlarged) {
        const glm::vec3 middle = (triangle.corners[0] + triangle.corners[1] + triangle.corners[2]) / 3.f;
        const double larger =
            double{enlargement[leaf]} * std::sqrt(areas[leaf] / triangleArea(mesh, mesh.leaf_triangles[t]));
        for (glm::vec3& corner : triangle.corners)
          corner = middles[leaf] + static_cast<float>(larger) * (corner - middle);
      }
      triangle.middle = middles[leaf];
      triangle.leaf = leaf;
      triangle.enlargement = enlargement[leaf];
      triangles.push_back(triangle);
    }
    builder.add(levels.leaves, triangles, mesh.vertices.size(), static_cast<float>(piece_area));
  };
  addLeaves(0.);
  std::vector<LevelTriangle> wood;
  for (const glm::uvec3& triangle : mesh.wood_triangles)
    wood.push_back(asItIs(mesh, triangle, mesh.leaf_triangles.size() + wood.size()));
  builder.add(levels.wood, wood, mesh.vertices.size(), 0.f);

  const double all = std::accumulate(areas.begin(), areas.end(), 0.),
               mean = all / std::max<double>(1., mesh.leaf_count);
  for (double area = kStep * mean; area * kFewestLeaves <= all; area *= kStep) addLeaves(area);
  const glm::vec3 extent = levels.box.empty() ? glm::vec3(0.f) : levels.box.size();
  const float largest = std::max({extent.x, extent.y, extent.z}) / 16.f;
  std::size_t before = wood.size();
  for (float reach = kFinestReach; reach<largest&& static_cast<double>(before)> kFewestTriangles;
       reach *= reach < kFineReach ? 2.f : static_cast<float>(kStep)) {
    const float piece_area = kReachesSquared * reach * reach;
    const SimpleWood simple = simpleWood(mesh, reach, piece_area);
    if (simple.triangles.size() > 4 * before / 5) continue;  // hardly simpler
    builder.add(levels.wood, simple.triangles, simple.shared_count, piece_area);
    before = simple.triangles.size();
  }
  builder.finish();
  return levels;
}

}  // namespace sunfleck::gl
