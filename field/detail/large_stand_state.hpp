#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <numbers>
#include <vector>

#include "field/large_stand.hpp"
#include "field/line_exchange.hpp"

// What LargeStandField keeps.
namespace sunfleck {
namespace detail {

inline constexpr double kLargeStandLight = 0.5e9;  // that light at trees' walls may take at once [byte]

inline constexpr double kBytesOfPixel = sizeof(float) + sizeof(std::uint32_t);  // of a TreePicture

// Steps whose times are told.
enum LargeStandCost : std::size_t { kKinds, kCells, kSun, kCellSolution, kWalls, kTrees };

// As a tree is turned that stands so.
inline glm::vec3 turnedBy(const glm::vec3& v, float rotation) {
  const float cosine = std::cos(rotation), sine = std::sin(rotation);
  return {cosine * v.x - sine * v.y, sine * v.x + cosine * v.y, v.z};
}

inline ElementOptics opticsOf(const FieldKind& kind, bool wood, std::size_t band) {
  if (wood) return {kind.wood_reflectance[static_cast<int>(band)], 0.f};
  return {kind.leaf[band].reflectance, kind.leaf[band].transmittance};
}

}  // namespace detail

// What of a kind does not depend on where its trees stand.
struct LargeStandField::Kind {
  FieldElements elements;
  std::vector<std::uint32_t> materials;  // 0 of leaves, 1 of wood
  LineExchange exchange;
  OutsideLines outside;
  std::vector<float> near_return;  // (F7) of leaves and of wood
  std::vector<float> per_line;     // irradiance of each element by radiance 1 on one line
  double escape = 0.;              // share of the lines from its leaves that leave the tree
  LeafClusters clusters;
  ClusterGroups groups;
  std::vector<std::uint32_t> group_side;  // of each side of each element
  Bounds box;

  FieldGeometry geometry() const { return {elements, exchange, materials, near_return, false}; }
};

// Trees of a kind that are turned alike.
struct LargeStandField::Turn {
  static constexpr std::size_t kNoSun = ~std::size_t{0};
  std::uint32_t kind = 0;
  float rotation = 0.f;
  TurnedClusters clusters;
  Bounds box;                          // of leaves and wood
  TreePicture picture;                 // as a sun sees it
  std::size_t of_sun = kNoSun;         // that sun, of the present ones
  std::vector<std::uint32_t> nearest;  // of each direction of the exchange, as it is turned, the nearest that is not
};

// What the light of the present suns, sky and optics makes.
struct LargeStandField::Lit {
  std::vector<SunLines> lines;                       // of each sun
  std::vector<std::vector<std::uint32_t>> of_cells;  // of each sun, lines that come to each element's sides
  std::vector<std::vector<std::uint32_t>> shaded;    // of each sun, lines that do not come to each column's ground
  std::vector<std::vector<std::vector<std::uint32_t>>> of_seen;  // of each sun, of each tree, lines to its sides
  std::vector<std::vector<LitPixels>> pixels;                    // and to which pixels of its picture they come
  std::vector<std::size_t> bands;                                // that differ
  std::array<std::size_t, kBands> as{};                          // of which of those each band is
  std::vector<GridSolution> solutions;                           // of those
  std::vector<std::vector<float>> scattered;  // of those, irradiance of elements' sides by all but the suns
};

}  // namespace sunfleck
