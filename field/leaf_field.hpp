#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "core/directions.hpp"
#include "core/leaf_optics.hpp"
#include "core/stand.hpp"
#include "core/tree_mesh.hpp"
#include "field/direct_light.hpp"
#include "field/elements.hpp"
#include "field/field_solver.hpp"
#include "field/line_exchange.hpp"
#include "field/lit_places.hpp"
#include "grid/product_graph.hpp"
#include "sky/sky_map.hpp"

namespace sunfleck {

// How finely the field is computed.
struct FieldEffort {
  ElementRule elements;
  ExchangeEffort exchange;
  DirectEffort direct;
  SolverEffort solver;
};

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
  std::vector<FieldSun> suns;         // at most kMostSuns
  std::shared_ptr<const SkyMap> sky;  // none: black
  std::vector<FieldKind> kinds;       // of trees
  glm::vec3 ground_albedo{0.f};       // Lambertian [1], 0 .. 1
};

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

// (F4) The light of each leaf of a stand: direct, by pictures from the suns; scattered, by exchange along lines.
// Products are kept from one call to the next, and computed anew as far as what they follow from has changed: exchange
// from the stand alone, direct light from stand and suns' directions, solutions from these, optics, ground and sky.
// They are for suns of irradiance 1, so that other colours of the suns change no product. Not to be used by several
// threads at once; it uses all cores itself.
class LeafField {
 public:
  static constexpr std::size_t kMostSuns = 4;

  explicit LeafField(const FieldEffort& effort = {});

  // What stands: of each kind its mesh, and where its trees are. Throws InvalidInput as requireFinished does on meshes
  // of trees that stand, on leaves that masks cut out, a tree of no kind, and a place or period that is not finite.
  void setStand(std::span<const std::shared_ptr<const TreeMesh>> kinds, const Stand& stand);

  // Throws InvalidInput on a value out of its range, where the memory that it takes is more than there is, and where
  // there is no steady state.
  const FieldResult& solve(const FieldLighting& lighting);

  const FieldElements& elements() const { return elements_; }                  // of all trees, one after the other
  std::size_t firstLeaf(std::size_t tree) const { return first_leaf_[tree]; }  // in elements().leaf
  std::vector<ProductCost> costs() const {
    return graph_.costs();
  }  // elements, exchange, recollision, direct, solution

 private:
  // Light from a sun or, the last, from the sky.
  static constexpr std::size_t kSources = kMostSuns + 1, kSky = kMostSuns;

  FieldGeometry geometry() const;
  void makeElements();
  void makeSolutions(std::span<const std::size_t> stale);
  void compose();

  FieldEffort effort_;
  std::vector<std::shared_ptr<const TreeMesh>> meshes_;
  Stand stand_{.trees = {}};
  FieldLighting lighting_;

  ProductGraph graph_;
  ProductGraph::Product elements_product_, exchange_product_, recollision_product_, direct_product_, solution_product_;

  TreeMesh mesh_;                        // of all trees
  FieldElements elements_;               // of it
  std::vector<std::uint32_t> kinds_;     // of each element: 2 kind of leaves, 2 kind + 1 of wood
  std::vector<std::size_t> first_leaf_;  // of each tree, and one more
  LineExchange exchange_;
  std::vector<float> near_return_;  // (F7) of kinds_
  FieldAlbedo albedo_;
  double recollision_ = 0.;
  std::array<DirectLight, kMostSuns> direct_;
  std::array<LitPlaces, kMostSuns> lit_;
  std::array<std::array<FieldSolution, kBands>, kSources> solutions_;
  FieldResult result_;
};

}  // namespace sunfleck
