#include "core/tree_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/finished_mesh.hpp"
#include "core/require.hpp"

namespace sunfleck {
namespace {

std::size_t dropFlat(const TreeMesh& mesh, std::vector<glm::uvec3>& triangles) {
  return std::erase_if(triangles, [&](const glm::uvec3& t) { return !hasArea(triangleArea(mesh, t)); });
}

double shareOf(const std::vector<double>& shares, std::size_t triangle) {
  return shares.empty() ? 1. : shares[triangle];
}

// Those that bear a mask must be of use; of others, those of no use are dropped.
void checkPatches(TreeMesh& mesh, const std::string& source) {
  if (mesh.patch_of_triangle.empty()) return;
  require(mesh.patch_of_triangle.size() == mesh.leaf_triangles.size(),
          source + ": number of leaf triangles with images", mesh.patch_of_triangle.size(),
          "that of the leaf triangles");
  const auto nameOf = [&](std::size_t triangle) { return source + ": leaf triangle " + std::to_string(triangle + 1); };
  for (std::size_t i = 0; i < mesh.patch_of_triangle.size(); ++i) {
    std::uint32_t& number = mesh.patch_of_triangle[i];
    if (number == TreeMesh::kNoPatch) continue;
    if (number >= mesh.patches.size()) require(false, nameOf(i) + " patch", number, "below the number of patches");
    const LeafPatch& patch = mesh.patches[number];
    if (patch.mask == LeafPatch::kNoMask) {
      if (!isUsable(patch.corners)) number = TreeMesh::kNoPatch;
      continue;
    }
    if (patch.mask >= mesh.masks.size()) require(false, nameOf(i) + " mask", patch.mask, "below the number of masks");
    if (!isUsable(patch.corners)) validate(patch.corners, nameOf(i));
  }
}

// Drops leaf triangles of no area, and those whose mask leaves nothing of them, with their patches and their leaves.
std::size_t dropFlatLeaves(TreeMesh& mesh, const std::vector<double>& shares) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < mesh.leaf_triangles.size(); ++i) {
    if (!hasArea(triangleArea(mesh, mesh.leaf_triangles[i]) * shareOf(shares, i))) continue;
    mesh.leaf_triangles[kept] = mesh.leaf_triangles[i];
    if (!mesh.patch_of_triangle.empty()) mesh.patch_of_triangle[kept] = mesh.patch_of_triangle[i];
    if (!mesh.leaf_of_triangle.empty()) mesh.leaf_of_triangle[kept] = mesh.leaf_of_triangle[i];
    ++kept;
  }
  const std::size_t dropped = mesh.leaf_triangles.size() - kept;
  mesh.leaf_triangles.resize(kept);
  if (!mesh.patch_of_triangle.empty()) mesh.patch_of_triangle.resize(kept);
  if (!mesh.leaf_of_triangle.empty()) mesh.leaf_of_triangle.resize(kept);
  return dropped;
}

// The share of each leaf triangle that its mask leaves; nothing where there are no masks. Most of a tree's cards bear
// the same part of the image, of which the share is computed once.
std::vector<double> leafShares(const TreeMesh& mesh) {
  if (mesh.masks.empty()) return {};
  std::vector<double> shares(mesh.leaf_triangles.size(), 1.);
  std::map<std::tuple<std::uint32_t, float, float, float, float, float, float>, double> known;
  for (std::size_t i = 0; i < mesh.leaf_triangles.size(); ++i) {
    if (!isCut(mesh, i)) continue;
    const auto& [c, mask] = *patchOf(mesh, i);
    const auto [at, is_new] = known.try_emplace({mask, c[0].x, c[0].y, c[1].x, c[1].y, c[2].x, c[2].y}, 0.);
    if (is_new) at->second = opaqueShare(*mesh.masks[mask], c);
    shares[i] = at->second;
  }
  return shares;
}

// Union-find over vertices: `root` of two corners of a triangle is the same.
std::uint32_t rootOf(std::vector<std::uint32_t>& parent, std::uint32_t vertex) {
  while (parent[vertex] != vertex) vertex = parent[vertex] = parent[parent[vertex]];
  return vertex;
}

// Triangles of one leaf by `given`, where it is there, stay together.
void groupConnectedLeaves(TreeMesh& mesh, const std::vector<std::uint32_t>& given) {
  constexpr std::uint32_t unnamed = ~0u;
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0u);
  for (const glm::uvec3& t : mesh.leaf_triangles)
    for (int corner = 1; corner < 3; ++corner) parent[rootOf(parent, t[corner])] = rootOf(parent, t[0]);
  if (!given.empty()) {
    std::vector<std::uint32_t> vertex_of(std::size_t{*std::ranges::max_element(given)} + 1, unnamed);
    for (std::size_t i = 0; i < given.size(); ++i) {
      std::uint32_t& vertex = vertex_of[given[i]];
      if (vertex == unnamed) vertex = mesh.leaf_triangles[i].x;
      parent[rootOf(parent, mesh.leaf_triangles[i].x)] = rootOf(parent, vertex);
    }
  }

  std::vector<std::uint32_t> leaf_of_root(mesh.vertices.size(), unnamed);
  mesh.leaf_of_triangle.clear();
  mesh.leaf_of_triangle.reserve(mesh.leaf_triangles.size());
  mesh.leaf_count = 0;
  for (const glm::uvec3& t : mesh.leaf_triangles) {
    std::uint32_t& leaf = leaf_of_root[rootOf(parent, t[0])];
    if (leaf == unnamed) leaf = mesh.leaf_count++;
    mesh.leaf_of_triangle.push_back(leaf);
  }
}

Bounds boundsOf(const TreeMesh& mesh, const std::vector<glm::uvec3>& triangles) {
  Bounds box;
  for (const glm::uvec3& t : triangles)
    for (int corner = 0; corner < 3; ++corner) box.include(mesh.vertices[t[corner]]);
  return box;
}

}  // namespace

Dropped finish(TreeMesh& mesh, const std::string& source) {
  requireVertices(mesh, source);
  requireIndices(mesh, mesh.leaf_triangles, source + ": leaf");
  requireIndices(mesh, mesh.wood_triangles, source + ": wood");
  checkPatches(mesh, source);
  if (mesh.leaf_of_triangle.size() != mesh.leaf_triangles.size()) mesh.leaf_of_triangle.clear();
  for (const std::uint32_t leaf : mesh.leaf_of_triangle)
    if (leaf >= mesh.leaf_triangles.size())
      require(false, source + ": leaf of a triangle", leaf, "below the number of leaf triangles");
  const Dropped dropped{.leaf_triangles = dropFlatLeaves(mesh, leafShares(mesh)),
                        .wood_triangles = dropFlat(mesh, mesh.wood_triangles)};
  if (mesh.leaf_triangles.empty())
    throw InvalidInput(source + ": has no leaves (" + std::to_string(dropped.leaf_triangles) +
                       " leaf triangles of no area, " + std::to_string(mesh.wood_triangles.size()) +
                       " wood triangles): at least one leaf with an area is needed");
  groupConnectedLeaves(mesh, std::vector<std::uint32_t>(std::move(mesh.leaf_of_triangle)));
  return dropped;
}

const LeafPatch* patchOf(const TreeMesh& mesh, std::size_t leaf_triangle) {
  if (mesh.patch_of_triangle.empty()) return nullptr;
  const std::uint32_t patch = mesh.patch_of_triangle[leaf_triangle];
  return patch == TreeMesh::kNoPatch ? nullptr : &mesh.patches[patch];
}

bool isCut(const TreeMesh& mesh, std::size_t leaf_triangle) {
  const LeafPatch* const patch = patchOf(mesh, leaf_triangle);
  return patch && patch->mask != LeafPatch::kNoMask;
}

double triangleArea(const TreeMesh& mesh, const glm::uvec3& triangle) {
  const glm::dvec3 a = mesh.vertices[triangle.x];
  const glm::dvec3 b = mesh.vertices[triangle.y];
  const glm::dvec3 c = mesh.vertices[triangle.z];
  return 0.5 * glm::length(glm::cross(b - a, c - a));
}

std::vector<double> leafAreas(const TreeMesh& mesh) {
  std::vector<double> areas(mesh.leaf_count, 0.);
  const std::vector<double> shares = leafShares(mesh);
  for (std::size_t i = 0; i < mesh.leaf_triangles.size(); ++i)
    areas[mesh.leaf_of_triangle[i]] += shareOf(shares, i) * triangleArea(mesh, mesh.leaf_triangles[i]);
  return areas;
}

double leafArea(const TreeMesh& mesh) {
  double area = 0.;
  const std::vector<double> shares = leafShares(mesh);
  for (std::size_t i = 0; i < mesh.leaf_triangles.size(); ++i)
    area += shareOf(shares, i) * triangleArea(mesh, mesh.leaf_triangles[i]);
  return area;
}

Bounds leafBounds(const TreeMesh& mesh) {
  return boundsOf(mesh, mesh.leaf_triangles);
}

Bounds bounds(const TreeMesh& mesh) {
  Bounds box = leafBounds(mesh);
  box.include(boundsOf(mesh, mesh.wood_triangles));
  return box;
}

}  // namespace sunfleck
