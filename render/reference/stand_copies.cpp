#include "render/reference/detail/stand_copies.hpp"

#include <cmath>
#include <string>

#include "core/require.hpp"

namespace sunfleck::detail {
namespace {

constexpr double kMostCopies = 1e6;

void validate(std::size_t kinds, const Stand& stand) {
  std::vector<char> stands(kinds);
  require(!stand.trees.empty(), "Stand.trees", stand.trees.size(), "at least one tree");
  for (std::size_t i = 0; i < stand.trees.size(); ++i) {
    const std::string name = "Stand.trees[" + std::to_string(i) + "]";
    for (int axis = 0; axis < 3; ++axis)
      require(std::abs(stand.trees[i].position[axis]) <= 1e6f, name + ".position", stand.trees[i].position[axis],
              "finite and at most 1e6 m in size");
    require(std::isfinite(stand.trees[i].rotation), name + ".rotation", stand.trees[i].rotation, "finite");
    require(stand.trees[i].kind < kinds, name + ".kind", stand.trees[i].kind,
            "below the number of kinds, " + std::to_string(kinds));
    stands[stand.trees[i].kind] = true;
  }
  for (std::size_t kind = 0; kind < kinds; ++kind)
    require(stands[kind], "Stand.trees: number of those of kind " + std::to_string(kind), 0, "at least 1");
  if (!stand.period) return;
  for (int axis = 0; axis < 2; ++axis)
    require((*stand.period)[axis] > 0.f && (*stand.period)[axis] <= 1e6f, "Stand.period", (*stand.period)[axis],
            "above 0 and at most 1e6 m");
}

Copy rotation(const Placement& tree) {
  if (tree.rotation == 0.f) return {.kind = tree.kind};
  return {.kind = tree.kind,
          .cosine = static_cast<float>(std::cos(double{tree.rotation})),
          .sine = static_cast<float>(std::sin(double{tree.rotation}))};
}

// Box of the prototype rotated but not moved.
Bounds rotatedBox(const TreeMesh& mesh, const Copy& copy, bool with_wood) {
  Bounds box;
  const auto add = [&](const std::vector<glm::uvec3>& triangles) {
    for (const glm::uvec3& t : triangles)
      for (int corner = 0; corner < 3; ++corner) box.include(copy.rotated(mesh.vertices[t[corner]]));
  };
  add(mesh.leaf_triangles);
  if (with_wood) add(mesh.wood_triangles);
  return box;
}

// Whole periods by which a tree that spans low .. high is shifted to reach into cell_low .. cell_low + period.
struct Shifts {
  double first, last;
  double count() const { return last - first + 1.; }
};
Shifts shifts(float low, float high, float cell_low, float period) {
  return {std::ceil((double{cell_low} - double{high}) / double{period}),
          std::floor((double{cell_low} + double{period} - double{low}) / double{period})};
}

}  // namespace

StandCopies standCopies(std::span<const TreeMesh* const> kinds, const Stand& stand, bool with_wood,
                        const Bounds& others) {
  validate(kinds.size(), stand);
  std::vector<Copy> rotations;
  std::vector<Bounds> boxes;  // of each tree, where it stands
  Bounds whole = others;
  for (const Placement& tree : stand.trees) {
    rotations.push_back(rotation(tree));
    const Bounds box = rotatedBox(*kinds[tree.kind], rotations.back(), with_wood);
    boxes.push_back({.low = box.low + tree.position, .high = box.high + tree.position});
    whole.include(boxes.back());
  }

  require(whole.low.z <= whole.high.z, "number of leaves and pieces of wood", 0, "at least 1: nothing is to be met");
  for (int axis = 0; axis < 2; ++axis)
    if (whole.low[axis] > whole.high[axis]) whole.low[axis] = whole.high[axis] = 0.f;

  StandCopies result;
  // A single upright copy is traced as the mesh stands, without an instance: so its own origin is the best one.
  const bool single = stand.trees.size() == 1 && stand.trees[0].rotation == 0.f;
  result.origin = single ? stand.trees[0].position : whole.centre();
  result.box = whole;
  if (stand.period)
    for (int axis = 0; axis < 2; ++axis) {
      result.box.low[axis] = whole.centre()[axis] - 0.5f * (*stand.period)[axis];
      result.box.high[axis] = result.box.low[axis] + (*stand.period)[axis];
    }

  for (std::size_t i = 0; i < stand.trees.size(); ++i) {
    Copy copy = rotations[i];
    const glm::vec3 home = stand.trees[i].position - result.origin;
    if (!stand.period || boxes[i].empty()) {
      copy.translation = home;
      result.copies.push_back(copy);
      continue;
    }
    const glm::vec2 period = *stand.period;
    const Shifts x = shifts(boxes[i].low.x, boxes[i].high.x, result.box.low.x, period.x);
    const Shifts y = shifts(boxes[i].low.y, boxes[i].high.y, result.box.low.y, period.y);
    const double count = static_cast<double>(result.copies.size()) + x.count() * y.count();
    require(count <= kMostCopies, "Stand.period: number of tree copies that reach into one period", count,
            "at most 1e6");
    for (double ix = x.first; ix <= x.last; ++ix)
      for (double iy = y.first; iy <= y.last; ++iy) {
        copy.translation = home + glm::vec3(glm::dvec3(ix * double{period.x}, iy * double{period.y}, 0.));
        result.copies.push_back(copy);
      }
  }
  return result;
}

}  // namespace sunfleck::detail
