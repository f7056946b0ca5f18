#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/tree_mesh.hpp"

namespace sunfleck {

// When a leaf is too curved or too large to be one element: its triangles are then elements of their own.
struct ElementRule {
  float least_flatness = 0.985f;  // of a leaf that is one element: |sum of its triangles' area vectors| / its area [1]
  float largest_extent = 0.25f;   // of a leaf that is one element, in mean free paths among the leaves [1]
  float wood_patch = 1.f;         // side of the cells that gather wood, in square roots of the mean leaf area [1]
};

// (F1) What exchanges light in a tree: pieces of its surface that are lit evenly on either side. A leaf, or its
// triangles; of the wood, the triangles of a cell whose normals point alike. Leaves come first, near ones one after the
// other; then wood.
struct FieldElements {
  std::vector<float> area;                      // one-sided [m^2], > 0
  std::vector<glm::vec3> centre;                // of area [m]
  std::vector<glm::vec3> normal;                // of the front, which the triangles' corners turn about
                                                // counter-clockwise; the mean over a curved element [1]
  std::vector<std::uint32_t> leaf;              // that the element is part of; kWood
  std::vector<std::uint32_t> of_leaf_triangle;  // element that each leaf triangle is part of
  std::vector<std::uint32_t> of_wood_triangle;  // and each wood triangle
  std::size_t leaf_elements = 0;                // those before all wood
  float mean_free_path = 0.f;                   // of lines among the leaves [m]

  static constexpr std::uint32_t kWood = ~0u;
  std::size_t size() const { return area.size(); }
};
FieldElements fieldElements(const TreeMesh& mesh, const ElementRule& rule = {});

// The mean over the elements of each leaf, weighted by area, of a value of each element [as the value].
std::vector<float> leafMeans(const FieldElements& elements, std::size_t leaves, std::span<const float> of_elements);

}  // namespace sunfleck
