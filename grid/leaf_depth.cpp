#include "grid/leaf_depth.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <stdexcept>

#include "grid/neighbours.hpp"
#include "grid/stand_index.hpp"

namespace sunfleck {

namespace {

constexpr int kRows = 16;           // of a map, that are worth a task
constexpr std::size_t kTrees = 16;  // between two calls of the progress

// Sums over the light rays that meet a leaf: whole numbers, so that their order does not matter.
struct RaySums {
  std::uint64_t before = 0, beyond = 0, rays = 0;
};

// Another tree of the stand in the pixels of a tree's map: the rectangle of those in which its crossings may count.
struct ShiftedTree {
  const DeepOpacityMap* map;  // its own
  glm::vec3 displacement;     // [m]
  glm::vec2 scale,
      offset;            // from a pixel's numbers to those, rounded down, of the one that holds this tree's crossings
  glm::ivec2 pixels;     // the same where both maps are one
  float depth;           // how much deeper they lie [m]
  glm::ivec2 low, high;  // high is beyond the last

  ShiftedTree(const DeepOpacityMap& light, const DeepOpacityMap& own_map, const glm::vec3& from_leaves)
      : map(&own_map), displacement(from_leaves) {
    const glm::vec3 shift = light.inMap(displacement);
    depth = shift.z;
    const glm::vec2 size(light.size());  // shifts beyond it need not fit an int
    if (map == &light) {
      pixels = glm::ivec2(glm::clamp(glm::floor(0.5f - glm::vec2(shift) / light.pixelSize()), -size, size));
      low = glm::max(glm::ivec2(0), -pixels);
      high = glm::min(light.size(), light.size() - pixels);
      return;
    }
    scale = glm::vec2(light.pixelSize() / map->pixelSize());
    offset = (light.corner() - glm::vec2(shift) - map->corner()) / map->pixelSize() + 0.5f * scale;
    low = glm::ivec2(glm::clamp(glm::floor(-offset / scale), glm::vec2(0.f), size));
    high = glm::ivec2(glm::clamp(glm::ceil((glm::vec2(map->size()) - offset) / scale), glm::vec2(0.f), size));
  }
  bool meets() const { return low.x < high.x && low.y < high.y; }
  std::span<const Crossing> crossings(const DeepOpacityMap& light, int x, int y) const {
    if (map == &light) return map->crossings(x + pixels.x, y + pixels.y);
    const glm::ivec2 at(glm::floor(scale * glm::vec2(x, y) + offset));
    if (at.x < 0 || at.y < 0 || at.x >= map->size().x || at.y >= map->size().y) return {};
    return map->crossings(at.x, at.y);
  }
};

// Adds the tree's own crossings on the lines through a row of pixels.
void addOwnRow(const DeepOpacityMap& light, int y, std::vector<RaySums>& sums) {
  for (int x = 0; x < light.size().x; ++x) {
    const std::span<const Crossing> line = light.crossings(x, y);
    std::size_t passed = 0;
    for (std::size_t i = 0; i < line.size(); ++i) {
      while (line[passed].depth < line[i].depth) ++passed;
      RaySums& leaf = sums[line[i].leaf];
      leaf.before += passed;
      leaf.beyond += line.size() - passed - 1;
      ++leaf.rays;
      for (std::size_t j = 0; j < i; ++j)  // a folded leaf does not stand in its own light
        if (line[j].leaf == line[i].leaf) {
          --leaf.beyond;
          --(line[j].depth < line[i].depth ? leaf.before : leaf.beyond);
        }
    }
  }
}

// Adds the crossings of other trees on them. `met` and `before` are room for work.
void addOthersRow(const DeepOpacityMap& light, std::span<const ShiftedTree> trees, int y,
                  std::vector<const ShiftedTree*>& met, std::vector<std::uint32_t>& before,
                  std::vector<RaySums>& sums) {
  met.clear();
  for (const ShiftedTree& tree : trees)
    if (y >= tree.low.y && y < tree.high.y) met.push_back(&tree);
  if (met.empty()) return;
  for (int x = 0; x < light.size().x; ++x) {
    const std::span<const Crossing> line = light.crossings(x, y);
    if (line.empty()) continue;
    before.assign(line.size(), 0);
    std::size_t all = 0;
    for (const ShiftedTree* tree : met) {
      if (x < tree->low.x || x >= tree->high.x) continue;
      const std::span<const Crossing> others = tree->crossings(light, x, y);
      std::uint32_t passed = 0;  // both lines are sorted by depth
      for (std::size_t i = 0; i < line.size(); ++i) {
        while (passed < others.size() && others[passed].depth + tree->depth < line[i].depth) ++passed;
        before[i] += passed;
      }
      all += others.size();
    }
    if (all == 0) continue;
    for (std::size_t i = 0; i < line.size(); ++i) {
      sums[line[i].leaf].before += before[i];
      sums[line[i].leaf].beyond += all - before[i];
    }
  }
}

// Sums over the rows of the light's map: add_row(y, sums), in parallel.
template <typename AddRow>
std::vector<RaySums> overRows(const DeepOpacityMap& light, std::size_t leaves, const AddRow& add_row) {
  tbb::enumerable_thread_specific<std::vector<RaySums>> by_thread{std::vector<RaySums>(leaves)};
  tbb::parallel_for(tbb::blocked_range<int>(0, light.size().y, kRows), [&](const tbb::blocked_range<int>& rows) {
    std::vector<RaySums>& sums = by_thread.local();
    for (int y = rows.begin(); y != rows.end(); ++y) add_row(y, sums);
  });
  std::vector<RaySums> sums(leaves);
  for (const std::vector<RaySums>& part : by_thread)
    for (std::size_t leaf = 0; leaf < sums.size(); ++leaf) {
      sums[leaf].before += part[leaf].before;
      sums[leaf].beyond += part[leaf].beyond;
      sums[leaf].rays += part[leaf].rays;
    }
  return sums;
}

// What the leaves of one tree meet of the others.
std::vector<RaySums> metOfOthers(const DeepOpacityMap& light, std::span<const ShiftedTree> trees,
                                 std::span<const RaySums> own, std::span<const glm::vec3> centres) {
  if (trees.empty()) return std::vector<RaySums>(own.size());
  std::vector<RaySums> sums = overRows(light, own.size(), [&](int y, std::vector<RaySums>& into) {
    thread_local std::vector<const ShiftedTree*> met;
    thread_local std::vector<std::uint32_t> before;
    addOthersRow(light, trees, y, met, before, into);
  });
  for (std::size_t leaf = 0; leaf < own.size(); ++leaf) {
    if (own[leaf].rays > 0) continue;
    for (const ShiftedTree& tree : trees) {
      const DeepOpacityMap::Counts counts = tree.map->counts(centres[leaf] - tree.displacement);
      sums[leaf].before += static_cast<std::uint64_t>(counts.before);
      sums[leaf].beyond += static_cast<std::uint64_t>(counts.beyond);
    }
  }
  return sums;
}

// What they meet of their own tree. A leaf that no ray meets has its centre's counts and no rays.
std::vector<RaySums> metOfOwn(const DeepOpacityMap& light, std::span<const glm::vec3> centres) {
  std::vector<RaySums> sums =
      overRows(light, centres.size(), [&](int y, std::vector<RaySums>& into) { addOwnRow(light, y, into); });
  for (std::uint32_t leaf = 0; leaf < sums.size(); ++leaf) {
    if (sums[leaf].rays > 0) continue;
    const DeepOpacityMap::Counts counts = light.counts(centres[leaf], leaf);
    sums[leaf].before = static_cast<std::uint64_t>(counts.before);
    sums[leaf].beyond = static_cast<std::uint64_t>(counts.beyond);
  }
  return sums;
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

std::vector<LeafDepths> leafDepths(std::span<const LitKind> kinds, const Stand& stand, const Progress& progress) {
  struct Kind {
    std::vector<glm::vec3> centres;
    std::vector<RaySums> own;
    Bounds box;
    Bounds reached;  // from somewhere in the box to somewhere in that of any kind
  };
  std::vector<Kind> of_kinds;
  float width = 1e-6f;
  glm::ivec2 around(0);
  for (const LitKind& kind : kinds) {
    Kind& of = of_kinds.emplace_back();
    of.centres = leafCentres(*kind.mesh);
    of.own = metOfOwn(*kind.light, of.centres);
    of.box = leafBounds(*kind.mesh);
    width = std::max({width, of.box.size().x, of.box.size().y});
    around = glm::max(around, periodsAround(stand, of.box));
  }
  for (Kind& of : of_kinds)
    for (const Kind& other : of_kinds)
      of.reached.include(Bounds{other.box.low - of.box.high, other.box.high - of.box.low});
  std::vector<glm::vec3> positions;
  for (const Placement& tree : stand.trees) positions.push_back(tree.position);
  const StandIndex index(positions, width, stand.period, around);

  std::vector<LeafDepths> result(stand.trees.size());
  const auto makeDepths = [&](std::size_t tree) {
    const std::size_t kind = stand.trees[tree].kind;
    const DeepOpacityMap& light = *kinds[kind].light;
    const std::vector<RaySums>& own = of_kinds[kind].own;
    std::vector<ShiftedTree> others;
    index.along(positions[tree], of_kinds[kind].reached, light.along(),
                [&](std::uint32_t other, const glm::vec3& displacement) {
                  if (other == tree && displacement == glm::vec3(0.f)) return;
                  const ShiftedTree shifted(light, *kinds[stand.trees[other].kind].light, displacement);
                  if (shifted.meets()) others.push_back(shifted);
                });
    const std::vector<RaySums> met = metOfOthers(light, others, own, of_kinds[kind].centres);
    LeafDepths& depths = result[tree];
    depths.depth.reserve(own.size());
    depths.thickness.reserve(own.size());
    for (std::size_t leaf = 0; leaf < own.size(); ++leaf) {
      const auto rays = static_cast<double>(std::max<std::uint64_t>(own[leaf].rays, 1));
      const std::uint64_t before = own[leaf].before + met[leaf].before, beyond = own[leaf].beyond + met[leaf].beyond;
      depths.depth.push_back(static_cast<float>(static_cast<double>(before) / rays));
      depths.thickness.push_back(static_cast<float>(static_cast<double>(before + beyond) / rays + 1.));
    }
  };
  for (std::size_t first = 0; first < result.size(); first += kTrees) {
    if (!goOn(progress, static_cast<double>(first) / static_cast<double>(result.size())))
      throw std::runtime_error("interrupted");
    tbb::parallel_for(first, std::min(result.size(), first + kTrees), makeDepths);
  }
  return result;
}

std::vector<LeafDepths> leafDepths(const TreeMesh& mesh, const DeepOpacityMap& light, const Stand& stand,
                                   const Progress& progress) {
  const LitKind kind{&mesh, &light};
  return leafDepths(std::span(&kind, 1), stand, progress);
}

}  // namespace sunfleck
