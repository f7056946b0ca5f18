#include "plants/detail/cut_cards.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <utility>

#include "core/require.hpp"
#include "plants/detail/mask_outline.hpp"
#include "plants/detail/mask_triangles.hpp"

namespace sunfleck::detail {
namespace {

constexpr std::size_t kMostTriangles = 50'000'000;

using Convex = std::vector<glm::dvec2>;  // counter-clockwise

// The part of a polygon on the left of the line from a to b (Sutherland & Hodgman 1974).
Convex leftOf(const glm::dvec2& a, const glm::dvec2& b, const Convex& polygon) {
  Convex rest;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double of_p = turnOf(a, b, p), of_q = turnOf(a, b, q);
    if (of_p >= 0.) rest.push_back(p);
    if ((of_p < 0. && of_q > 0.) || (of_p > 0. && of_q < 0.)) rest.push_back(p + of_p / (of_p - of_q) * (q - p));
  }
  return rest;
}

// The part of a mask's triangles within a convex window of the repeated image.
MaskTriangles clipped(const MaskTriangles& leaf, const Convex& window) {
  glm::dvec2 low = window[0], high = window[0];
  for (const glm::dvec2& corner : window) {
    low = glm::min(low, corner);
    high = glm::max(high, corner);
  }
  // Corners on the edge of a repeat, give or take what a file's decimals lose, bring no sliver of the next one in.
  constexpr double kRounding = 1e-5;
  MaskTriangles cut;
  for (double row = std::floor(low.y + kRounding); row < high.y - kRounding; ++row)
    for (double column = std::floor(low.x + kRounding); column < high.x - kRounding; ++column) {
      std::vector<std::uint32_t> number(leaf.corners.size(), ~0u);  // of corners that are taken over
      for (const glm::uvec3& t : leaf.triangles) {
        std::array<glm::dvec2, 3> corners;
        for (int c = 0; c < 3; ++c) corners[static_cast<std::size_t>(c)] = leaf.corners[t[c]] + glm::dvec2(column, row);
        const auto isInside = [&](const glm::dvec2& p) {
          for (std::size_t i = 0; i < window.size(); ++i)
            if (turnOf(window[i], window[(i + 1) % window.size()], p) < -kRounding) return false;
          return true;
        };
        if (std::ranges::all_of(corners, isInside)) {
          glm::uvec3 whole;
          for (int c = 0; c < 3; ++c) {
            std::uint32_t& known = number[t[c]];
            if (known == ~0u) {
              known = static_cast<std::uint32_t>(cut.corners.size());
              cut.corners.push_back(corners[static_cast<std::size_t>(c)]);
            }
            whole[c] = known;
          }
          cut.triangles.push_back(whole);
          continue;
        }
        Convex part(corners.begin(), corners.end());
        for (std::size_t i = 0; i < window.size() && part.size() >= 3; ++i)
          part = leftOf(window[i], window[(i + 1) % window.size()], part);
        if (part.size() < 3) continue;
        const auto first = static_cast<std::uint32_t>(cut.corners.size());
        cut.corners.insert(cut.corners.end(), part.begin(), part.end());
        for (std::uint32_t i = 1; i + 1 < part.size(); ++i) cut.triangles.push_back({first, first + i, first + i + 1});
      }
    }
  return cut;
}

// One or two triangles on which an image lies flat: a card, or a piece of it.
struct Card {
  std::uint32_t mask;
  Convex window;  // in the image
  glm::dvec3 origin, along_u, along_v;
  std::uint32_t leaf;
};

// What a card's window shows of the leaf of its mask; its triangles are patches of the mesh, one after the other.
struct Part {
  MaskTriangles leaf;
  std::uint32_t first_patch = 0;
};

class CardCutter {
 public:
  CardCutter(TreeMesh& mesh, const std::string& source) : mesh_(mesh), source_(source) {}

  void cut() {
    const std::vector<glm::uvec3> triangles = std::move(mesh_.leaf_triangles);
    const std::vector<std::uint32_t> patches = std::move(mesh_.patch_of_triangle);
    const std::vector<std::uint32_t> leaf_of = std::move(mesh_.leaf_of_triangle);
    mesh_.leaf_triangles = {};
    mesh_.patch_of_triangle = {};
    mesh_.leaf_of_triangle = {};
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      const LeafPatch* const patch = patches[i] == TreeMesh::kNoPatch ? nullptr : &mesh_.patches[patches[i]];
      if (!patch || patch->mask == LeafPatch::kNoMask) {
        mesh_.leaf_triangles.push_back(triangles[i]);
        mesh_.patch_of_triangle.push_back(patches[i]);
        mesh_.leaf_of_triangle.push_back(leaf_of[i]);
        continue;
      }
      validate(patch->corners, source_ + ": leaf triangle " + std::to_string(i + 1));
      Card card = cardOf(triangles[i], *patch, leaf_of[i]);
      if (i + 1 < triangles.size() && patches[i + 1] != TreeMesh::kNoPatch && leaf_of[i + 1] == leaf_of[i]) {
        const LeafPatch& next = mesh_.patches[patches[i + 1]];
        if (next.mask == patch->mask && join(card, triangles[i], triangles[i + 1], next)) ++i;
      }
      add(card);
    }
    mesh_.masks.clear();
    dropPatchesOfMasks();
  }

 private:
  Card cardOf(const glm::uvec3& t, const LeafPatch& shown, std::uint32_t leaf) const {
    Card card{.mask = shown.mask, .window = {}, .origin = {}, .along_u = {}, .along_v = {}, .leaf = leaf};
    for (const glm::vec2& corner : shown.corners) card.window.emplace_back(corner);
    const glm::dvec3 a = mesh_.vertices[t.x], b = mesh_.vertices[t.y], c = mesh_.vertices[t.z];
    const glm::dvec2 of_b = card.window[1] - card.window[0], of_c = card.window[2] - card.window[0];
    const double determinant = of_b.x * of_c.y - of_b.y * of_c.x;
    card.along_u = (of_c.y * (b - a) - of_b.y * (c - a)) / determinant;
    card.along_v = (of_b.x * (c - a) - of_c.x * (b - a)) / determinant;
    card.origin = a - card.window[0].x * card.along_u - card.window[0].y * card.along_v;
    if (determinant < 0.) std::swap(card.window[1], card.window[2]);
    return card;
  }

  // Takes the next triangle in where it shares an edge and the image lies on it in the same way: cut as one, the two
  // need no corners on the edge between them.
  bool join(Card& card, const glm::uvec3& t, const glm::uvec3& next, const LeafPatch& of_next) const {
    const auto isNew = [&](std::uint32_t v) { return v != t.x && v != t.y && v != t.z; };
    const int new_corners = isNew(next.x) + isNew(next.y) + isNew(next.z);
    if (new_corners != 1) return false;
    for (const glm::vec2& corner : of_next.corners)
      for (int axis = 0; axis < 2; ++axis)
        if (!(std::abs(corner[axis]) <= kMostImageRepeats)) return false;
    const int opposite = isNew(next.x) ? 0 : isNew(next.y) ? 1 : 2;
    double size = 0.;
    for (int c = 0; c < 3; ++c)
      size = std::max(
          size, glm::distance(glm::dvec3(mesh_.vertices[next[c]]), glm::dvec3(mesh_.vertices[next[(c + 1) % 3]])));
    constexpr double kFlat = 1e-3;  // over the size; a file's decimals lose less
    for (int c = 0; c < 3; ++c) {
      const glm::dvec2 at = of_next.corners[static_cast<std::size_t>(c)];
      const glm::dvec3 there = card.origin + at.x * card.along_u + at.y * card.along_v;
      if (glm::distance(there, glm::dvec3(mesh_.vertices[next[c]])) > kFlat * size) return false;
    }
    // The new corner comes between those of the shared edge.
    const glm::dvec2 corner = of_next.corners[static_cast<std::size_t>(opposite)];
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec2 &a = card.window[i], &b = card.window[(i + 1) % 3], &c = card.window[(i + 2) % 3];
      if (turnOf(a, b, corner) >= 0.) continue;
      if (turnOf(a, corner, c) < 0. || turnOf(corner, b, c) < 0.) return false;  // not convex
      card.window.insert(card.window.begin() + static_cast<std::ptrdiff_t>(i) + 1, corner);
      return true;
    }
    return false;
  }

  // Most cards of a tree bear the same part of the same image.
  const Part& partOf(const Card& card) {
    std::vector<double> key{static_cast<double>(card.mask)};
    for (const glm::dvec2& corner : card.window) key.insert(key.end(), {corner.x, corner.y});
    const auto [known, is_new] = parts_.try_emplace(std::move(key));
    if (is_new) {
      const auto [leaf, first] = leaves_.try_emplace(card.mask);
      if (first) leaf->second = trianglesOf(*mesh_.masks[card.mask], source_);
      known->second = {.leaf = clipped(leaf->second, card.window),
                       .first_patch = static_cast<std::uint32_t>(mesh_.patches.size())};
      const MaskTriangles& part = known->second.leaf;
      for (const glm::uvec3& t : part.triangles)
        mesh_.patches.push_back({{part.corners[t.x], part.corners[t.y], part.corners[t.z]}});
    }
    return known->second;
  }

  void add(const Card& card) {
    const auto& [part, first_patch] = partOf(card);
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    require(mesh_.leaf_triangles.size() + part.triangles.size() <= kMostTriangles,
            source_ + ": number of triangles of cut leaves", mesh_.leaf_triangles.size() + part.triangles.size(),
            "at most 50000000: take them as they are (--cards mask)");
    for (const glm::dvec2& corner : part.corners)
      mesh_.vertices.emplace_back(card.origin + corner.x * card.along_u + corner.y * card.along_v);
    for (std::uint32_t i = 0; i < part.triangles.size(); ++i) {
      mesh_.leaf_triangles.push_back(first + part.triangles[i]);
      mesh_.leaf_of_triangle.push_back(card.leaf);
      mesh_.patch_of_triangle.push_back(first_patch + i);
    }
  }

  void dropPatchesOfMasks() {
    std::vector<std::uint32_t> number(mesh_.patches.size(), TreeMesh::kNoPatch);
    std::vector<LeafPatch> kept;
    for (std::size_t i = 0; i < number.size(); ++i) {
      if (mesh_.patches[i].mask != LeafPatch::kNoMask) continue;
      number[i] = static_cast<std::uint32_t>(kept.size());
      kept.push_back(mesh_.patches[i]);
    }
    mesh_.patches = std::move(kept);
    for (std::uint32_t& patch : mesh_.patch_of_triangle)
      if (patch != TreeMesh::kNoPatch) patch = number[patch];
  }

  TreeMesh& mesh_;
  const std::string& source_;
  std::map<std::uint32_t, MaskTriangles> leaves_;  // of each mask
  std::map<std::vector<double>, Part> parts_;      // by mask and window
};

}  // namespace

void cutCards(TreeMesh& mesh, const std::string& source) {
  if (!mesh.masks.empty()) CardCutter(mesh, source).cut();
}

}  // namespace sunfleck::detail
