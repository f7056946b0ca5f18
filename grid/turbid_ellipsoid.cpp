#include <cmath>
#include <glm/geometric.hpp>

#include "core/require.hpp"
#include "grid/detail/density_cells.hpp"

namespace sunfleck {
namespace {

constexpr int kSamples = 4;  // along each axis of a cell, of which some may lie within

// Share of a cell's samples within the ellipsoid x^2 + y^2 + z^2 <= 1 of the scaled place.
double shareWithin(const glm::dvec3& low, double side, const glm::dvec3& centre, const glm::dvec3& half) {
  int within = 0;
  for (int i = 0; i < kSamples * kSamples * kSamples; ++i) {
    const glm::dvec3 sample(i % kSamples, i / kSamples % kSamples, i / (kSamples * kSamples));
    const glm::dvec3 place = (low + side * (sample + 0.5) / double{kSamples} - centre) / half;
    within += glm::dot(place, place) <= 1.;
  }
  return double(within) / (kSamples * kSamples * kSamples);
}

}  // namespace

DensityGrid DensityGrid::turbidEllipsoid(const glm::vec3& size, const glm::vec3& centre, float density,
                                         float cell_size) {
  constexpr double kMostCells = 512.;  // along an axis
  constexpr float kLongest = 1e4f;     // [m]
  const double side = double{cell_size};
  require(density > 0.f && density <= 1e6f, "turbid ellipsoid: density [1/m]", density, "above 0 and at most 1e6");
  require(cell_size > 0.f && cell_size <= kLongest, "turbid ellipsoid: cells' side [m]", cell_size,
          "above 0 and at most 1e4");
  glm::ivec3 first, last;
  for (int axis = 0; axis < 3; ++axis) {
    require(size[axis] > 0.f && size[axis] <= kLongest, "turbid ellipsoid: axis [m]", size[axis],
            "above 0 and at most 1e4");
    require(std::abs(centre[axis]) <= kLongest, "turbid ellipsoid: centre [m]", centre[axis], "within 1e4");
    require(double{size[axis]} / side <= kMostCells, "turbid ellipsoid: cells along an axis", double{size[axis]} / side,
            "at most 512");
    first[axis] = static_cast<int>(std::floor((double{centre[axis]} - 0.5 * double{size[axis]}) / side));
    last[axis] = static_cast<int>(std::floor((double{centre[axis]} + 0.5 * double{size[axis]}) / side));
  }
  DensityTrees trees;
  openvdb::tree::ValueAccessor<openvdb::FloatTree> cells(*trees.density);
  const glm::dvec3 half = 0.5 * glm::dvec3(size);
  for (int x = first.x; x <= last.x; ++x)
    for (int y = first.y; y <= last.y; ++y)
      for (int z = first.z; z <= last.z; ++z)
        if (const double share = shareWithin(side * glm::dvec3(x, y, z), side, glm::dvec3(centre), half); share > 0.)
          cells.setValue({x, y, z}, static_cast<float>(share * double{density}));
  if (trees.density->empty()) cells.setValue({first.x, first.y, first.z}, density);  // smaller than a sample
  return DensityGrid(std::make_shared<const Cells>(std::move(trees), side, glm::dvec3(0.)));
}

}  // namespace sunfleck
