#include "grid/leaf_depth.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "grid/neighbours.hpp"

namespace sunfleck {

namespace {

constexpr int kRows = 16;  // of a map, that are worth a task

// Sums over the light rays that meet a leaf: whole numbers, so that their order does not matter.
struct RaySums {
  std::uint64_t before = 0, beyond = 0, rays = 0;
};

// A tree of the stand in the pixels of the light's map of another.
struct ShiftedTree {
  glm::ivec2 pixels;  // from a pixel of the map to the one that holds this tree's crossings
  float depth;        // how much deeper they lie [m]

  ShiftedTree(const DeepOpacityMap& light, glm::vec3 displacement) {
    const glm::vec3 shift = light.inMap(displacement);
    pixels = glm::ivec2(glm::floor(0.5f - glm::vec2(shift) / light.pixelSize()));
    depth = shift.z;
  }
};

// Adds the rays through a row of pixels. Trees of the stand: those whose crossings may count, the leaves' own included.
void addRow(const DeepOpacityMap& light, std::span<const ShiftedTree> trees, int y, std::vector<std::uint32_t>& before,
            std::vector<RaySums>& sums) {
  for (int x = 0; x < light.size().x; ++x) {
    const std::span<const Crossing> line = light.crossings(x, y);
    if (line.empty()) continue;
    before.assign(line.size(), 0);
    std::size_t all = 0;
    for (const ShiftedTree& tree : trees) {
      const glm::ivec2 pixel = glm::ivec2(x, y) + tree.pixels;
      if (pixel.x < 0 || pixel.y < 0 || pixel.x >= light.size().x || pixel.y >= light.size().y) continue;
      const std::span<const Crossing> others = light.crossings(pixel.x, pixel.y);
      std::uint32_t passed = 0;  // both lines are sorted by depth
      for (std::size_t i = 0; i < line.size(); ++i) {
        while (passed < others.size() && others[passed].depth + tree.depth < line[i].depth) ++passed;
        before[i] += passed;
      }
      all += others.size();
    }
    for (std::size_t i = 0; i < line.size(); ++i) {
      RaySums& leaf = sums[line[i].leaf];
      leaf.before += before[i];
      leaf.beyond += all - before[i] - 1;
      ++leaf.rays;
      for (std::size_t j = 0; j < i; ++j)  // a folded leaf does not stand in its own light
        if (line[j].leaf == line[i].leaf) {
          --leaf.beyond;
          --(line[j].depth < line[i].depth ? leaf.before : leaf.beyond);
        }
    }
  }
}

}  // namespace

std::vector<glm::vec3> leafCentres(const TreeMesh& mesh) {
  std::vector<glm::dvec4> sums(mesh.leaf_count, glm::dvec4(0.));  // of area times (position, 1)
  for (std::size_t i = 0; i < mesh.leaf_triangles.size(); ++i) {
    const glm::uvec3& t = mesh.leaf_triangles[i];
    const glm::dvec3 corners =
        glm::dvec3(mesh.vertices[t.x]) + glm::dvec3(mesh.vertices[t.y]) + glm::dvec3(mesh.vertices[t.z]);
    sums[mesh.leaf_of_triangle[i]] += triangleArea(mesh, t) * glm::dvec4(corners / 3., 1.);
  }
  std::vector<glm::vec3> centres;
  centres.reserve(mesh.leaf_count);
  for (const glm::dvec4& sum : sums) centres.emplace_back(glm::dvec3(sum) / sum.w);
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
  std::vector<glm::vec3> displacements = neighboursAlong(neighbours, leafBounds(mesh), light.along());
  displacements.emplace_back(0.f);
  std::vector<ShiftedTree> trees;
  for (const glm::vec3& t : displacements) trees.emplace_back(light, t);

  tbb::enumerable_thread_specific<std::vector<RaySums>> by_thread{std::vector<RaySums>(mesh.leaf_count)};
  tbb::parallel_for(tbb::blocked_range<int>(0, light.size().y, kRows), [&](const tbb::blocked_range<int>& rows) {
    std::vector<RaySums>& sums = by_thread.local();
    std::vector<std::uint32_t> before;
    for (int y = rows.begin(); y != rows.end(); ++y) addRow(light, trees, y, before, sums);
  });
  std::vector<RaySums> sums(mesh.leaf_count);
  for (const std::vector<RaySums>& part : by_thread)
    for (std::size_t leaf = 0; leaf < sums.size(); ++leaf) {
      sums[leaf].before += part[leaf].before;
      sums[leaf].beyond += part[leaf].beyond;
      sums[leaf].rays += part[leaf].rays;
    }

  std::vector<glm::vec3> centres;  // found if a leaf needs one
  LeafDepths result;
  result.depth.reserve(mesh.leaf_count);
  result.thickness.reserve(mesh.leaf_count);
  for (std::uint32_t leaf = 0; leaf < mesh.leaf_count; ++leaf) {
    RaySums& s = sums[leaf];
    if (s.rays == 0) {
      if (centres.empty()) centres = leafCentres(mesh);
      for (const glm::vec3& t : displacements) {
        const bool own_tree = &t == &displacements.back();
        const DeepOpacityMap::Counts counts =
            light.counts(centres[leaf] - t, own_tree ? leaf : DeepOpacityMap::kNoLeaf);
        s.before += static_cast<std::uint64_t>(counts.before);
        s.beyond += static_cast<std::uint64_t>(counts.beyond);
      }
      s.rays = 1;
    }
    const auto rays = static_cast<double>(s.rays);
    result.depth.push_back(static_cast<float>(static_cast<double>(s.before) / rays));
    result.thickness.push_back(static_cast<float>(static_cast<double>(s.before + s.beyond) / rays + 1.));
  }
  return result;
}

}  // namespace sunfleck
