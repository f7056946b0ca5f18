#include "render/reference/detail/stand_copies.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <string>
#include <tuple>

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

// Whole multiples of 64 m, far from a mesh's middle only: none for trees that grow where they are.
glm::vec3 pivotOf(const TreeMesh& mesh) {
  const Bounds box = bounds(mesh);
  return box.empty() ? glm::vec3(0.f) : 64.f * glm::round(box.centre() / 64.f);
}

// What the box of a prototype, turned about z in any way, follows from: the corners of the convex hull seen from above.
struct Outline {
  std::vector<glm::vec3> corners;  // about the pivot; z means nothing [m]
  float low = 0.f, high = 0.f;     // z about the pivot [m]
};

// By A. M. Andrew's monotone chain (1979).
Outline outlineOf(const TreeMesh& mesh, const glm::vec3& pivot, bool with_wood) {
  std::vector<glm::vec3> points;
  Bounds box;
  const auto add = [&](const std::vector<glm::uvec3>& triangles) {
    for (const glm::uvec3& t : triangles)
      for (int corner = 0; corner < 3; ++corner) {
        const glm::vec3 point = mesh.vertices[t[corner]] - pivot;
        box.include(point);
        points.push_back(point);
      }
  };
  add(mesh.leaf_triangles);
  if (with_wood) add(mesh.wood_triangles);
  std::ranges::sort(points,
                    [](const glm::vec3& a, const glm::vec3& b) { return std::tie(a.x, a.y) < std::tie(b.x, b.y); });
  const auto turnsLeft = [](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0.;
  };
  Outline outline{.corners = {}, .low = box.low.z, .high = box.high.z};
  for (int side = 0; side < 2; ++side) {
    const std::size_t first = outline.corners.size();
    for (const glm::vec3& point : points) {
      auto& corners = outline.corners;
      while (corners.size() >= first + 2 && !turnsLeft(corners[corners.size() - 2], corners.back(), point))
        corners.pop_back();
      corners.push_back(point);
    }
    std::ranges::reverse(points);
  }
  return outline;
}

// Box of the prototype about its pivot, rotated but not moved.
Bounds rotatedBox(const Outline& outline, const Copy& copy) {
  Bounds box;
  for (const glm::vec3& corner : outline.corners) box.include(copy.rotated(corner));
  box.low.z = outline.low;
  box.high.z = outline.high;
  return box;
}

// Where a tree has its pivot, which turns with it about the mesh's origin [m].
glm::dvec3 homeOf(const Placement& tree, const glm::dvec3& pivot) {
  const double cosine = std::cos(double{tree.rotation}), sine = std::sin(double{tree.rotation});
  const glm::dvec3 turned(cosine * pivot.x - sine * pivot.y, sine * pivot.x + cosine * pivot.y, pivot.z);
  return glm::dvec3(tree.position) + turned;
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
  StandCopies result;
  std::vector<Outline> outlines;  // of each kind
  for (const TreeMesh* mesh : kinds) {
    result.pivots.push_back(pivotOf(*mesh));
    outlines.push_back(outlineOf(*mesh, result.pivots.back(), with_wood));
  }
  std::vector<Copy> rotations;
  std::vector<Bounds> boxes;  // of each tree about its home
  std::vector<glm::dvec3> homes;
  glm::dvec3 low(others.low), high(others.high);
  for (const Placement& tree : stand.trees) {
    rotations.push_back(rotation(tree));
    boxes.push_back(rotatedBox(outlines[tree.kind], rotations.back()));
    homes.push_back(homeOf(tree, result.pivots[tree.kind]));
    low = glm::min(low, homes.back() + glm::dvec3(boxes.back().low));
    high = glm::max(high, homes.back() + glm::dvec3(boxes.back().high));
  }

  require(low.z <= high.z, "number of leaves and pieces of wood", 0, "at least 1: nothing is to be met");
  for (int axis = 0; axis < 2; ++axis)
    if (low[axis] > high[axis]) low[axis] = high[axis] = 0.;

  // A single upright copy is traced as the mesh stands, without an instance: so its own origin is the best one.
  const bool single = stand.trees.size() == 1 && stand.trees[0].rotation == 0.f;
  result.origin = glm::vec3(single ? homes[0] : 0.5 * (low + high));
  const auto fromOrigin = [&](const glm::dvec3& point) {
    return single ? glm::vec3(0.f) : glm::vec3(point - glm::dvec3(result.origin));
  };
  for (std::size_t i = 0; i < boxes.size(); ++i)
    result.box.include({.low = boxes[i].low + fromOrigin(homes[i]), .high = boxes[i].high + fromOrigin(homes[i])});
  result.box.include({.low = others.low - result.origin, .high = others.high - result.origin});
  for (int axis = 0; axis < 2; ++axis)
    if (result.box.low[axis] > result.box.high[axis]) result.box.low[axis] = result.box.high[axis] = 0.f;
  if (stand.period)
    for (int axis = 0; axis < 2; ++axis) {
      result.box.low[axis] = result.box.centre()[axis] - 0.5f * (*stand.period)[axis];
      result.box.high[axis] = result.box.low[axis] + (*stand.period)[axis];
    }

  for (std::size_t i = 0; i < stand.trees.size(); ++i) {
    Copy copy = rotations[i];
    const glm::vec3 home = fromOrigin(homes[i]);
    if (!stand.period || boxes[i].empty()) {
      copy.translation = home;
      result.copies.push_back(copy);
      continue;
    }
    const glm::vec2 period = *stand.period;
    const Shifts x = shifts(home.x + boxes[i].low.x, home.x + boxes[i].high.x, result.box.low.x, period.x);
    const Shifts y = shifts(home.y + boxes[i].low.y, home.y + boxes[i].high.y, result.box.low.y, period.y);
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
