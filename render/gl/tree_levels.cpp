#include "render/gl/tree_levels.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "core/random.hpp"
#include "grid/deep_opacity_map.hpp"

namespace sunfleck::gl {
namespace {

constexpr std::size_t kClusterTriangles = 64, kFewestLeaves = 32;
constexpr std::uint64_t kSeed = 25;

// The bits of ten, with two zeros between each.
std::uint32_t apart(std::uint32_t x) {
  x = (x | x << 16) & 0x030000ffu;
  x = (x | x << 8) & 0x0300f00fu;
  x = (x | x << 4) & 0x030c30c3u;
  return (x | x << 2) & 0x09249249u;
}

// Place of a point of the box on Morton's curve, which keeps near ones together.
std::uint32_t mortonCode(const Bounds& box, const glm::vec3& point) {
  const glm::vec3 part = (point - box.low) / glm::max(box.size(), glm::vec3(1e-6f));
  const glm::uvec3 cell(glm::clamp(part * 1023.f, 0.f, 1023.f));
  return apart(cell.x) | apart(cell.y) << 1 | apart(cell.z) << 2;
}

// Triangles to be put into a level.
struct Piece {
  std::array<glm::vec3, 3> corners;
  std::array<std::uint32_t, 3> shared;  // numbers of the corners, where triangles share them
  TriangleData data;
};

TriangleData dataOf(const Piece& piece, float enlargement, const glm::vec3& middle, std::uint32_t leaf) {
  const glm::dvec3 a = piece.corners[0], b = piece.corners[1], c = piece.corners[2];
  const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
  return {.plane = glm::vec4(glm::vec3(normal) * enlargement, static_cast<float>(glm::dot(normal, (a + b + c) / 3.))),
          .leaf = glm::vec4(middle, std::bit_cast<float>(leaf))};
}

class Builder {
 public:
  explicit Builder(TreeLevels& levels) : levels_(levels) {}

  // Adds triangles, which get the next numbers, and the level that they make.
  //   shared_count  numbers that corners have
  void add(std::vector<Level>& into, const std::vector<Piece>& pieces, std::size_t shared_count, float enlargement) {
    constexpr std::uint32_t none = ~0u;
    const auto first = static_cast<std::uint32_t>(levels_.triangles.size());
    const auto count = static_cast<std::uint32_t>(pieces.size());
    // Each triangle owns the vertex of its number; where it can, one of a corner that others share.
    std::vector<std::uint32_t> vertex_of(shared_count, none);
    std::vector<int> own(count);
    for (std::uint32_t i = 0; i < count; ++i) {
      const Piece& piece = pieces[i];
      for (int corner = 0; corner < 3; ++corner)
        if (vertex_of[piece.shared[static_cast<std::size_t>(corner)]] == none) {
          own[i] = corner;
          vertex_of[piece.shared[static_cast<std::size_t>(corner)]] = first + i;
          break;
        }
      owned_.push_back(piece.corners[static_cast<std::size_t>(own[i])]);
      levels_.triangles.push_back(piece.data);
    }
    const auto vertexAt = [&](const Piece& piece, std::size_t corner) {
      std::uint32_t& vertex = vertex_of[piece.shared[corner]];
      if (vertex == none) {
        vertex = kExtra + static_cast<std::uint32_t>(extra_.size());
        extra_.push_back(piece.corners[corner]);
      }
      return vertex;
    };

    Bounds box;
    for (const Piece& piece : pieces)
      for (const glm::vec3& corner : piece.corners) box.include(corner);
    levels_.box.include(box);
    std::vector<std::uint32_t> order(count), code(count);
    std::iota(order.begin(), order.end(), 0u);
    for (std::uint32_t i = 0; i < count; ++i) code[i] = mortonCode(box, pieces[i].corners[0]);
    std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
      return code[a] != code[b] ? code[a] < code[b] : a < b;
    });
    Level& level = into.emplace_back();
    level.enlargement = enlargement;
    for (std::size_t i = 0; i < count; ++i) {
      if (i % kClusterTriangles == 0)
        level.clusters.push_back({.first_index = static_cast<std::uint32_t>(levels_.indices.size())});
      const Piece& piece = pieces[order[i]];
      const auto last = static_cast<std::size_t>(own[order[i]]);
      for (const std::size_t corner : {(last + 1) % 3, (last + 2) % 3}) levels_.indices.push_back(vertexAt(piece, corner));
      levels_.indices.push_back(first + order[i]);
      for (const glm::vec3& corner : piece.corners) level.clusters.back().box.include(corner);
      level.clusters.back().end_index = static_cast<std::uint32_t>(levels_.indices.size());
    }
  }

  // Vertices that no triangle owns come after all others.
  void finish() {
    levels_.vertices = std::move(owned_);
    for (std::uint32_t& index : levels_.indices)
      if (index >= kExtra) index = index - kExtra + static_cast<std::uint32_t>(levels_.vertices.size());
    levels_.vertices.insert(levels_.vertices.end(), extra_.begin(), extra_.end());
  }

 private:
  static constexpr std::uint32_t kExtra = 1u << 31;
  TreeLevels& levels_;
  std::vector<glm::vec3> owned_, extra_;
};

std::vector<std::uint32_t> randomRanks(std::size_t count) {
  std::vector<std::uint32_t> order(count), rank(count);
  std::iota(order.begin(), order.end(), 0u);
  Random random(kSeed, 0);
  for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[random.bits() % i]);
  for (std::uint32_t i = 0; i < count; ++i) rank[order[i]] = i;
  return rank;
}

}  // namespace

TreeLevels treeLevels(const TreeMesh& mesh) {
  TreeLevels levels;
  Builder builder(levels);
  const std::vector<double> areas = leafAreas(mesh);
  const double all_area = std::accumulate(areas.begin(), areas.end(), 0.);
  const std::size_t leaf_count = mesh.leaf_count;
  levels.leaf_area = leaf_count == 0 ? 0.f : static_cast<float>(all_area / static_cast<double>(leaf_count));

  std::vector<glm::dvec3> middles(leaf_count);
  for (std::size_t t = 0; t < mesh.leaf_triangles.size(); ++t) {
    const glm::uvec3& corners = mesh.leaf_triangles[t];
    const glm::dvec3 sum = glm::dvec3(mesh.vertices[corners.x]) + glm::dvec3(mesh.vertices[corners.y]) +
                           glm::dvec3(mesh.vertices[corners.z]);
    middles[mesh.leaf_of_triangle[t]] += triangleArea(mesh, corners) / 3. * sum;
  }
  for (std::size_t leaf = 0; leaf < leaf_count; ++leaf) middles[leaf] /= std::max(areas[leaf], 1e-300);

  const std::vector<std::uint32_t> rank = randomRanks(leaf_count);
  const auto addLeaves = [&](std::size_t kept) {
    double kept_area = 0.;
    for (std::size_t leaf = 0; leaf < leaf_count; ++leaf)
      if (rank[leaf] < kept) kept_area += areas[leaf];
    const float enlargement = kept == leaf_count ? 1.f : static_cast<float>(std::sqrt(all_area / kept_area));
    std::vector<Piece> pieces;
    for (std::size_t t = 0; t < mesh.leaf_triangles.size(); ++t) {
      const std::uint32_t leaf = mesh.leaf_of_triangle[t];
      if (rank[leaf] >= kept) continue;
      const glm::vec3 middle(middles[leaf]);
      Piece piece;
      for (int corner = 0; corner < 3; ++corner) {
        const std::uint32_t vertex = mesh.leaf_triangles[t][corner];
        const glm::vec3 at = mesh.vertices[vertex];
        piece.corners[static_cast<std::size_t>(corner)] = kept == leaf_count ? at : middle + enlargement * (at - middle);
        piece.shared[static_cast<std::size_t>(corner)] = vertex;
      }
      piece.data = dataOf(piece, enlargement, middle, leaf);
      pieces.push_back(piece);
    }
    builder.add(levels.leaves, pieces, mesh.vertices.size(), enlargement);
  };
  const auto addWood = [&] {
    std::vector<Piece> pieces;
    for (const glm::uvec3& triangle : mesh.wood_triangles) {
      Piece piece;
      for (int corner = 0; corner < 3; ++corner) {
        piece.corners[static_cast<std::size_t>(corner)] = mesh.vertices[triangle[corner]];
        piece.shared[static_cast<std::size_t>(corner)] = triangle[corner];
      }
      piece.data = dataOf(piece, 1.f, glm::vec3(0.f), DeepOpacityMap::kNoLeaf);
      pieces.push_back(piece);
    }
    builder.add(levels.wood, pieces, mesh.vertices.size(), 1.f);
  };
  addLeaves(leaf_count);
  addWood();
  for (std::size_t kept = leaf_count / 2; kept >= kFewestLeaves; kept /= 2) addLeaves(kept);
  builder.finish();
  return levels;
}

}  // namespace sunfleck::gl
