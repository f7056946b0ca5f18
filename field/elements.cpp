#include "field/elements.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>
#include <utility>

#include "core/morton_order.hpp"

namespace sunfleck {
namespace {

struct Surface {
  glm::vec3 centre, vector;  // of a triangle [m], and its normal times its area [m^2]
  float area;                // [m^2]
};

Surface surfaceOf(const TreeMesh& mesh, const glm::uvec3& triangle) {
  const glm::vec3 &a = mesh.vertices[triangle.x], &b = mesh.vertices[triangle.y], &c = mesh.vertices[triangle.z];
  // In double precision: squares of small areas are none in single.
  const glm::dvec3 vector = 0.5 * glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
  return {(a + b + c) / 3.f, glm::vec3(vector), static_cast<float>(glm::length(vector))};
}

std::vector<Surface> surfacesOf(const TreeMesh& mesh, const std::vector<glm::uvec3>& triangles) {
  std::vector<Surface> surfaces;
  surfaces.reserve(triangles.size());
  for (const glm::uvec3& triangle : triangles) surfaces.push_back(surfaceOf(mesh, triangle));
  return surfaces;
}

// Leaves that become single elements, and where leaves are.
struct WholeLeaves {
  std::vector<char> whole;
  std::vector<glm::vec3> centres;  // of their boxes [m]
  float mean_free_path;
};

// Lines cross 1/2 leaf area per volume, where leaves are turned every way; the crown is taken for the ellipsoid in its
// box.
WholeLeaves wholeLeaves(const TreeMesh& mesh, const std::vector<Surface>& surfaces, const ElementRule& rule) {
  std::vector<Surface> leaves(mesh.leaf_count, Surface{glm::vec3(0.f), glm::vec3(0.f), 0.f});
  std::vector<Bounds> boxes(mesh.leaf_count);
  double total = 0.;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const std::uint32_t leaf = mesh.leaf_of_triangle[i];
    leaves[leaf].vector += surfaces[i].vector;
    leaves[leaf].area += surfaces[i].area;
    total += double{surfaces[i].area};
    for (int corner = 0; corner < 3; ++corner) boxes[leaf].include(mesh.vertices[mesh.leaf_triangles[i][corner]]);
  }
  const glm::vec3 size = glm::max(leafBounds(mesh).size(), glm::vec3(1e-6f));
  WholeLeaves result{std::vector<char>(mesh.leaf_count), std::vector<glm::vec3>(mesh.leaf_count),
                     static_cast<float>(2. * 0.5236 * double{size.x} * double{size.y} * double{size.z} / total)};
  for (std::size_t leaf = 0; leaf < leaves.size(); ++leaf) {
    result.whole[leaf] = glm::length(leaves[leaf].vector) >= rule.least_flatness * leaves[leaf].area &&
                         glm::length(boxes[leaf].size()) <= rule.largest_extent * result.mean_free_path;
    result.centres[leaf] = boxes[leaf].centre();
  }
  return result;
}

void add(FieldElements& elements, std::uint32_t element, const Surface& surface) {
  elements.area[element] += surface.area;
  elements.centre[element] += surface.area * surface.centre;
  elements.normal[element] += surface.vector;
}

std::uint32_t addElement(FieldElements& elements, std::uint32_t leaf) {
  elements.area.push_back(0.f);
  elements.centre.emplace_back(0.f);
  elements.normal.emplace_back(0.f);
  elements.leaf.push_back(leaf);
  return static_cast<std::uint32_t>(elements.size() - 1);
}

int facingOf(const glm::vec3& vector) {
  const glm::vec3 size = glm::abs(vector);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  return 2 * axis + (vector[axis] < 0.f);
}

void addWood(FieldElements& elements, const TreeMesh& mesh, float cell_size) {
  const std::vector<Surface> surfaces = surfacesOf(mesh, mesh.wood_triangles);
  // Cell and facing in one number; 19 bits for a cell's place along an axis reach far beyond any mesh.
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(surfaces.size());
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis)
      key = key << 19 |
            (static_cast<std::uint64_t>(std::floor(surfaces[i].centre[axis] / cell_size) + 262'144.f) & 0x7ffff);
    keys[i] = {key << 3 | static_cast<std::uint64_t>(facingOf(surfaces[i].vector)), static_cast<std::uint32_t>(i)};
  }
  std::sort(keys.begin(), keys.end());
  elements.of_wood_triangle.resize(surfaces.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const bool together = i > 0 && keys[i].first == keys[i - 1].first;
    const auto element =
        together ? static_cast<std::uint32_t>(elements.size() - 1) : addElement(elements, FieldElements::kWood);
    elements.of_wood_triangle[keys[i].second] = element;
    add(elements, element, surfaces[keys[i].second]);
  }
}

}  // namespace

// (F1)
FieldElements fieldElements(const TreeMesh& mesh, const ElementRule& rule) {
  FieldElements elements;
  const std::vector<Surface> surfaces = surfacesOf(mesh, mesh.leaf_triangles);
  const WholeLeaves leaves = wholeLeaves(mesh, surfaces, rule);
  elements.mean_free_path = leaves.mean_free_path;
  std::vector<std::uint32_t> next(mesh.leaf_count);  // element of each leaf's next triangle
  for (std::size_t i = 0; i < surfaces.size(); ++i) ++next[mesh.leaf_of_triangle[i]];
  for (const std::uint32_t leaf : mortonOrder(leaves.centres)) {
    const std::uint32_t triangles = next[leaf], first = static_cast<std::uint32_t>(elements.size());
    for (std::uint32_t i = 0; i < (leaves.whole[leaf] ? 1u : triangles); ++i) addElement(elements, leaf);
    next[leaf] = first;
  }
  double leaf_area = 0.;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const std::uint32_t leaf = mesh.leaf_of_triangle[i], element = next[leaf];
    if (!leaves.whole[leaf]) ++next[leaf];
    elements.of_leaf_triangle.push_back(element);
    add(elements, element, surfaces[i]);
    leaf_area += double{surfaces[i].area};
  }
  elements.leaf_elements = elements.size();
  const double mean_leaf = leaf_area / std::max(1., static_cast<double>(mesh.leaf_count));
  addWood(elements, mesh, std::max(rule.wood_patch * static_cast<float>(std::sqrt(mean_leaf)), 1e-4f));
  for (std::size_t i = 0; i < elements.size(); ++i) {
    elements.centre[i] /= elements.area[i];
    const float length = glm::length(elements.normal[i]);
    elements.normal[i] = length > 0.f ? elements.normal[i] / length : glm::vec3(0.f, 0.f, 1.f);
  }
  return elements;
}

std::vector<float> leafMeans(const FieldElements& elements, std::size_t leaves, std::span<const float> of_elements) {
  std::vector<double> sums(leaves), areas(leaves);
  for (std::size_t i = 0; i < elements.leaf_elements; ++i) {
    sums[elements.leaf[i]] += double{elements.area[i]} * double{of_elements[i]};
    areas[elements.leaf[i]] += double{elements.area[i]};
  }
  std::vector<float> means(leaves);
  for (std::size_t leaf = 0; leaf < leaves; ++leaf)
    means[leaf] = areas[leaf] > 0. ? static_cast<float>(sums[leaf] / areas[leaf]) : 0.f;
  return means;
}

}  // namespace sunfleck
