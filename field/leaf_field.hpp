#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "core/progress.hpp"
#include "core/stand.hpp"
#include "core/tree_mesh.hpp"
#include "field/direct_light.hpp"
#include "field/elements.hpp"
#include "field/field_lighting.hpp"
#include "field/field_result.hpp"
#include "field/field_solver.hpp"
#include "field/line_exchange.hpp"
#include "field/lit_places.hpp"
#include "field/stand_elements.hpp"
#include "grid/foliage_stand.hpp"
#include "grid/product_graph.hpp"

namespace sunfleck {

// How finely the field is computed.
struct FieldEffort {
  ElementRule elements;
  ExchangeEffort exchange;
  DirectEffort direct;
  SolverEffort solver;
};

// (F4) The light of each leaf of a stand: direct, by pictures from the suns; scattered, by exchange along lines.
// Products are kept from one call to the next, and computed anew as far as what they follow from has changed: exchange
// from the stand alone, direct light from stand and suns' directions, solutions from these, optics, ground and sky.
// They are for suns of irradiance 1, so that other colours of the suns change no product. Not to be used by several
// threads at once; it uses all cores itself.
class LeafField {
 public:
  static constexpr std::size_t kMostSuns = kMostFieldSuns;

  explicit LeafField(const FieldEffort& effort = {});

  // What stands: of each kind its mesh, and where its trees are. Computes nothing yet. Throws InvalidInput as
  // requireFieldStand() does.
  void setStand(std::span<const std::shared_ptr<const TreeMesh>> kinds, const Stand& stand);

  // Throws InvalidInput on a value out of its range, where the memory that it takes is more than there is, and where
  // there is no steady state; std::runtime_error("interrupted") when `progress` ends it, which it asks after each axis
  // of lines and each iteration: what was made till then stays, and it may be asked again.
  const FieldResult& solve(const FieldLighting& lighting, const Progress& progress = {});
  // Whether solve() would compute no product anew.
  bool upToDate(std::span<const std::shared_ptr<const TreeMesh>> kinds, const Stand& stand,
                const FieldLighting& lighting) const;

  // (F31) Irradiance of the ground's cells by what leaves and wood send down, per band, as last solved.
  std::vector<glm::vec3> groundLight(const GroundGrid& grid) const;

  const FieldElements& elements() const { return elements_.elements; }                  // of all trees
  std::size_t firstLeaf(std::size_t tree) const { return elements_.first_leaf[tree]; }  // in elements().leaf
  std::vector<ProductCost> costs() const {
    return graph_.costs();
  }  // elements, exchange, recollision, direct, solution

 private:
  // Light from a sun or, the last, from the sky.
  static constexpr std::size_t kSources = kMostSuns + 1, kSky = kMostSuns;

  FieldGeometry geometry() const;
  bool sameStand(std::span<const std::shared_ptr<const TreeMesh>> kinds, const Stand& stand) const;
  bool sameOptics(const FieldLighting& lighting) const;
  bool sameDirection(const FieldLighting& lighting, std::size_t sun) const;
  void makeSolutions(std::span<const std::size_t> stale, const Progress& progress);
  std::vector<FieldPart> parts() const;

  FieldEffort effort_;
  std::vector<std::shared_ptr<const TreeMesh>> meshes_;
  Stand stand_{.trees = {}};
  FieldLighting lighting_;

  ProductGraph graph_;
  ProductGraph::Product elements_product_, exchange_product_, recollision_product_, direct_product_, solution_product_;

  StandElements elements_;
  LineExchange exchange_;
  std::vector<float> near_return_;  // (F7) of the elements' kinds
  FieldAlbedo albedo_;
  double recollision_ = 0.;
  std::array<DirectLight, kMostSuns> direct_;
  std::array<LitPlaces, kMostSuns> lit_;
  std::array<std::array<FieldSolution, kBands>, kSources> solutions_;
  FieldResult result_;
};

}  // namespace sunfleck
