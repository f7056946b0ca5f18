#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/leaf_optics.hpp"
#include "field/direct_light.hpp"
#include "field/field_lighting.hpp"
#include "field/field_solver.hpp"
#include "field/stand_elements.hpp"

namespace sunfleck {

// Irradiance of the two sides of a leaf per one-sided area; the front is the one that its triangles' corners turn about
// counter-clockwise [unit of the light].
struct SideIrradiance {
  float front = 0.f, back = 0.f;
};
struct LeafLight {
  std::array<SideIrradiance, kBands> direct;     // straight from the suns
  std::array<SideIrradiance, kBands> scattered;  // all the rest, the sky's light too
};

struct FieldResult {
  std::vector<std::vector<LeafLight>> trees;   // of each tree of the stand, of each of its leaves
  std::array<FieldBalance, kBands> balance{};  // where the light went, per band [unit of the light, m^2]
  int iterations = 0;                          // the most that a problem took
  double error_bound = 0.;                     // the largest of a problem: see FieldSolution [1]
  bool converged = true;
};

// A source's share of the light: a sun, or the sky.
struct FieldPart {
  glm::vec3 scale{1.f};                 // of its light, per band
  const DirectLight* direct = nullptr;  // of a sun, for irradiance 1
  std::array<const FieldSolution*, kBands> solutions{};
};
// (F4) What each element's front and back send out, all light together, per band [unit of the light / sr].
//   kinds  of trees
std::vector<glm::vec3> sentRadiance(const StandElements& stand, std::span<const FieldPart> parts,
                                    std::span<const FieldKind> kinds);
// The light of each leaf by all parts together; a leaf of several elements has their mean by area.
FieldResult fieldResult(const StandElements& stand, std::span<const FieldPart> parts);

}  // namespace sunfleck
