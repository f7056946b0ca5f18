#include "plants/detail/leaf_grouping.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <numeric>
#include <vector>

namespace sunfleck::detail {
namespace {

constexpr std::uint32_t kNone = ~0u;

std::uint64_t mixed(std::uint64_t a, std::uint64_t b) {
  std::uint64_t x = (a + 0x9e3779b97f4a7c15u) * 0xbf58476d1ce4e5b9u ^ b;
  x = (x ^ (x >> 29)) * 0x94d049bb133111ebu;
  return x ^ (x >> 32);
}

// Finds equals among things that have numbers.
class NumberTable {
 public:
  explicit NumberTable(std::size_t most) : slots_(std::bit_ceil(2 * most + 2), kNone) {}

  // The first number that was added of things the same as this one: itself where it is the first.
  template <typename Same>
  std::uint32_t firstOf(std::uint32_t number, std::uint64_t hash, const Same& same) {
    for (std::size_t slot = hash & (slots_.size() - 1);; slot = (slot + 1) & (slots_.size() - 1)) {
      if (slots_[slot] == kNone) slots_[slot] = number;
      if (slots_[slot] == number || same(slots_[slot])) return slots_[slot];
    }
  }

 private:
  std::vector<std::uint32_t> slots_;
};

class LeafGrouper {
 public:
  explicit LeafGrouper(TreeMesh& mesh) : mesh_(mesh), parent_(mesh.vertices.size()) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }

  std::size_t group() {
    placeVertices();
    const std::size_t doubled = dropDoubled();
    for (const glm::uvec3& t : mesh_.leaf_triangles) {
      unite(t.x, t.y);
      unite(t.x, t.z);
    }
    if (any_shared_) uniteEdges();
    number();
    return doubled;
  }

 private:
  // For each corner of leaves the first one at the same place.
  void placeVertices() {
    const std::vector<glm::vec3>& vertices = mesh_.vertices;
    place_.assign(vertices.size(), kNone);
    shared_.assign(vertices.size(), false);
    NumberTable table(std::min(vertices.size(), 3 * mesh_.leaf_triangles.size()));
    const auto bits = [](float x) { return std::uint64_t{std::bit_cast<std::uint32_t>(x + 0.f)}; };  // -0 is 0
    for (const glm::uvec3& t : mesh_.leaf_triangles)
      for (int c = 0; c < 3; ++c) {
        const std::uint32_t vertex = t[c];
        if (place_[vertex] != kNone) continue;
        const glm::vec3& v = vertices[vertex];
        place_[vertex] = table.firstOf(vertex, mixed(bits(v.x) << 32 | bits(v.y), bits(v.z)),
                                       [&](std::uint32_t other) { return vertices[other] == v; });
        if (place_[vertex] != vertex) any_shared_ = shared_[place_[vertex]] = true;
      }
  }

  glm::uvec3 sortedPlaces(const glm::uvec3& t) const {
    glm::uvec3 places(place_[t.x], place_[t.y], place_[t.z]);
    if (places.x > places.y) std::swap(places.x, places.y);
    if (places.y > places.z) std::swap(places.y, places.z);
    if (places.x > places.y) std::swap(places.x, places.y);
    return places;
  }

  // Those of no area are left for finish() to count.
  std::size_t dropDoubled() {
    std::vector<glm::uvec3>& triangles = mesh_.leaf_triangles;
    NumberTable table(triangles.size());
    std::vector<glm::uvec3> kept_places;
    kept_places.reserve(triangles.size());
    const std::size_t count = triangles.size();
    for (std::size_t i = 0; i < count; ++i) {
      const glm::uvec3 places = sortedPlaces(triangles[i]);
      const auto number = static_cast<std::uint32_t>(kept_places.size());
      kept_places.push_back(places);
      if (places.x != places.y && places.y != places.z &&
          table.firstOf(number, mixed(std::uint64_t{places.x} << 32 | places.y, places.z),
                        [&](std::uint32_t other) { return kept_places[other] == places; }) != number) {
        kept_places.pop_back();
        continue;
      }
      triangles[number] = triangles[i];
      if (!mesh_.patch_of_triangle.empty()) mesh_.patch_of_triangle[number] = mesh_.patch_of_triangle[i];
    }
    triangles.resize(kept_places.size());
    if (!mesh_.patch_of_triangle.empty()) mesh_.patch_of_triangle.resize(kept_places.size());
    return count - kept_places.size();
  }

  std::uint32_t rootOf(std::uint32_t vertex) {
    while (parent_[vertex] != vertex) vertex = parent_[vertex] = parent_[parent_[vertex]];
    return vertex;
  }
  void unite(std::uint32_t a, std::uint32_t b) { parent_[rootOf(a)] = rootOf(b); }

  void uniteEdges() {
    std::vector<glm::uvec3> edges;  // two places, the lower first, and a vertex of their triangle
    for (const glm::uvec3& t : mesh_.leaf_triangles)
      for (int c = 0; c < 3; ++c) {
        const std::uint32_t a = place_[t[c]], b = place_[t[(c + 1) % 3]];
        if (a != b && (shared_[a] || shared_[b])) edges.emplace_back(std::min(a, b), std::max(a, b), t.x);
      }
    NumberTable table(edges.size());
    for (std::uint32_t i = 0; i < edges.size(); ++i) {
      const std::uint32_t first = table.firstOf(i, mixed(edges[i].x, edges[i].y), [&](std::uint32_t other) {
        return edges[other].x == edges[i].x && edges[other].y == edges[i].y;
      });
      unite(edges[i].z, edges[first].z);
    }
  }

  void number() {
    std::vector<std::uint32_t> leaf_of_root(mesh_.vertices.size(), kNone);
    mesh_.leaf_of_triangle.clear();
    mesh_.leaf_of_triangle.reserve(mesh_.leaf_triangles.size());
    mesh_.leaf_count = 0;
    for (const glm::uvec3& t : mesh_.leaf_triangles) {
      std::uint32_t& leaf = leaf_of_root[rootOf(t.x)];
      if (leaf == kNone) leaf = mesh_.leaf_count++;
      mesh_.leaf_of_triangle.push_back(leaf);
    }
  }

  TreeMesh& mesh_;
  std::vector<std::uint32_t> place_;  // of each corner of a leaf
  std::vector<bool> shared_;          // whether several vertices are at the place of that number
  bool any_shared_ = false;
  std::vector<std::uint32_t> parent_;  // of vertices that are of one leaf (union-find)
};

}  // namespace

std::size_t groupLeaves(TreeMesh& mesh) {
  return LeafGrouper(mesh).group();
}

}  // namespace sunfleck::detail
