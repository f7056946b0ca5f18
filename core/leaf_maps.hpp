#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/leaf_optics.hpp"
#include "core/tree_mesh.hpp"

namespace sunfleck {

// What one side of a leaf does to light that arrives on it, at one place, per band.
struct LeafFace {
  glm::vec3 reflectance{0.f};   // rho [1], >= 0: beneath a gloss a share of what that lets in, as LeafOptics'
  glm::vec3 gloss{0.f};         // rho_s [1], 0 .. 1 (R20)
  std::uint32_t roughness = 0;  // of the gloss: which of LeafMaps::roughnesses
  bool operator==(const LeafFace&) const = default;
};

struct LeafPlace {
  glm::vec3 transmittance{0.f};  // tau [1], >= 0: the same from both sides, as light goes either way alike; with the
                                 // reflectance of each side at most 1
  std::array<LeafFace, 2>
      faces;  // the upper, about which the corners of leaf triangles turn counter-clockwise; the lower
  bool operator==(const LeafPlace&) const = default;
};

// Leaves that are not alike at all places or on both sides: what every place of a leaf's images does to light. All
// leaves of a tree show the same images, each triangle a part of them (LeafPatch); one whose part is not known shows
// the mean of both sides and all places, unless there is one place alone.
struct LeafMaps {
  int width = 1, height = 1;             // [place], 1 .. kMostMapWidth
  std::vector<LeafPlace> places;         // rows from top to bottom
  std::vector<float> roughnesses{0.3f};  // m [1], kLeastGlossRoughness .. 1; at most kMostRoughnesses
  bool operator==(const LeafMaps&) const = default;

  // The place of a point of the images, which repeat.
  std::size_t placeAt(const glm::vec2& point) const;
  bool glossy() const;
};
inline constexpr int kMostMapWidth = 4096;
inline constexpr std::size_t kMostRoughnesses = 8;

// Throws InvalidInput("<what>: ...") on numbers out of their ranges, and on numbers of places that do not fit.
void validate(const LeafMaps& maps, const std::string& what);

// The share of the tree's leaf area at each place of images of this size [1], by the places whose middles its triangles
// hold: together 1. Evenly spread where no triangle tells its place.
std::vector<float> leafAreaShares(const TreeMesh& mesh, int width, int height);

// What the leaves do on the average over both sides and all of their area; its roughness is the gloss's mean.
//   shares  leafAreaShares() of the tree and of the maps' size
BandOptics meanOptics(const LeafMaps& maps, std::span<const float> shares);

}  // namespace sunfleck
