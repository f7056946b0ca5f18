#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "core/directions.hpp"
#include "core/leaf_optics.hpp"
#include "core/stand.hpp"
#include "core/tree_mesh.hpp"
#include "sky/sky_map.hpp"

namespace sunfleck {

inline constexpr std::size_t kMostFieldSuns = 4;

// What shines on a stand, and what it does to light, per band.
struct FieldSun {
  Direction along{0.f, 0.f, -1.f};  // in which its light travels; z < 0
  glm::vec3 irradiance{1.f};        // of a plane that faces it [1], >= 0
  bool operator==(const FieldSun&) const = default;
};
struct FieldKind {
  BandOptics leaf;                   // Lambertian: a gloss is not regarded
  glm::vec3 wood_reflectance{0.3f};  // [1], 0 .. 1
  bool operator==(const FieldKind&) const = default;
};
struct FieldLighting {
  std::vector<FieldSun> suns;         // at most kMostFieldSuns
  std::shared_ptr<const SkyMap> sky;  // none: black
  std::vector<FieldKind> kinds;       // of trees
  glm::vec3 ground_albedo{0.f};       // Lambertian [1], 0 .. 1
};

// Throws InvalidInput on a mesh without leaves or with leaves that masks cut out, a tree of no kind, and a place or
// period that is not finite.
void requireFieldStand(std::span<const std::shared_ptr<const TreeMesh>> kinds, const Stand& stand);
// Throws InvalidInput on a value out of its range.
//   kinds  of trees in the stand
void requireFieldLighting(const FieldLighting& lighting, std::size_t kinds);

}  // namespace sunfleck
