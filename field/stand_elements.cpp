#include "field/stand_elements.hpp"

#include <tbb/parallel_for.h>

#include <cmath>
#include <numeric>

namespace sunfleck {
namespace {

// Its direction by the direction that a tree turns to.
glm::vec3 turned(const glm::vec3& vector, float cosine, float sine) {
  return {cosine * vector.x - sine * vector.y, sine * vector.x + cosine * vector.y, vector.z};
}

// Triangles in the order of their elements: near ones are worked on one after the other.
std::vector<std::uint32_t> byElement(const std::vector<std::uint32_t>& of_triangle, std::size_t elements) {
  std::vector<std::uint32_t> next(elements + 1), order(of_triangle.size());
  for (const std::uint32_t element : of_triangle) ++next[element + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[next[of_triangle[i]]++] = i;
  return order;
}

}  // namespace

std::vector<FieldElements> elementsOfKinds(std::span<const std::shared_ptr<const TreeMesh>> kinds, const Stand& stand,
                                           const ElementRule& rule) {
  std::vector<FieldElements> of_kinds(kinds.size());
  std::vector<char> stands(kinds.size());
  for (const Placement& tree : stand.trees) stands[tree.kind] = true;
  tbb::parallel_for(std::size_t{0}, kinds.size(), [&](std::size_t kind) {
    if (stands[kind]) of_kinds[kind] = fieldElements(*kinds[kind], rule);
  });
  return of_kinds;
}

StandElements standElements(std::span<const std::shared_ptr<const TreeMesh>> kinds,
                            std::span<const FieldElements> of_kinds, const Stand& stand) {
  StandElements all;
  TreeMesh& all_mesh = all.mesh;
  FieldElements& all_elements = all.elements;
  const auto take = [&](const Placement& tree, std::size_t begin, std::size_t end, std::uint32_t kind) {
    const FieldElements& elements = of_kinds[tree.kind];
    const float cosine = std::cos(tree.rotation), sine = std::sin(tree.rotation);
    for (std::size_t i = begin; i < end; ++i) {
      all_elements.area.push_back(elements.area[i]);
      all_elements.centre.push_back(tree.position + turned(elements.centre[i], cosine, sine));
      all_elements.normal.push_back(turned(elements.normal[i], cosine, sine));
      const bool wood = elements.leaf[i] == FieldElements::kWood;
      all_elements.leaf.push_back(wood ? FieldElements::kWood : all_mesh.leaf_count + elements.leaf[i]);
      all.kinds.push_back(kind);
    }
  };
  std::vector<std::uint32_t> first_vertex;
  for (const Placement& tree : stand.trees) {
    const TreeMesh& mesh = *kinds[tree.kind];
    const FieldElements& elements = of_kinds[tree.kind];
    const float cosine = std::cos(tree.rotation), sine = std::sin(tree.rotation);
    first_vertex.push_back(static_cast<std::uint32_t>(all_mesh.vertices.size()));
    for (const glm::vec3& vertex : mesh.vertices)
      all_mesh.vertices.push_back(tree.position + turned(vertex, cosine, sine));
    const auto first = static_cast<std::uint32_t>(all_elements.size());
    all.first_element.push_back(first);
    for (const std::uint32_t i : byElement(elements.of_leaf_triangle, elements.size())) {
      all_mesh.leaf_triangles.push_back(mesh.leaf_triangles[i] + first_vertex.back());
      all_mesh.leaf_of_triangle.push_back(all_mesh.leaf_count + mesh.leaf_of_triangle[i]);
      all_elements.of_leaf_triangle.push_back(first + elements.of_leaf_triangle[i]);
    }
    take(tree, 0, elements.leaf_elements, 2 * tree.kind);
    all.first_leaf.push_back(all_mesh.leaf_count);
    all_mesh.leaf_count += mesh.leaf_count;
  }
  all.first_leaf.push_back(all_mesh.leaf_count);
  all.first_element.push_back(all_elements.size());
  all_elements.leaf_elements = all_elements.size();
  for (std::size_t i = 0; i < stand.trees.size(); ++i) {
    const Placement& tree = stand.trees[i];
    const FieldElements& elements = of_kinds[tree.kind];
    all.first_wood.push_back(all_elements.size());
    const std::size_t first = all_elements.size() - elements.leaf_elements;  // wraps below 0 and back
    for (const std::uint32_t triangle : byElement(elements.of_wood_triangle, elements.size())) {
      all_mesh.wood_triangles.push_back(kinds[tree.kind]->wood_triangles[triangle] + first_vertex[i]);
      all_elements.of_wood_triangle.push_back(static_cast<std::uint32_t>(first + elements.of_wood_triangle[triangle]));
    }
    take(tree, elements.leaf_elements, elements.size(), 2 * tree.kind + 1);
  }
  all.first_wood.push_back(all_elements.size());
  return all;
}

}  // namespace sunfleck
