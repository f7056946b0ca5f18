#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/progress.hpp"
#include "core/stand.hpp"
#include "core/tree_mesh.hpp"
#include "field/cell_medium.hpp"
#include "field/clumping.hpp"
#include "field/direct_light.hpp"
#include "field/elements.hpp"
#include "field/field_lighting.hpp"
#include "field/field_result.hpp"
#include "field/grid_field.hpp"
#include "field/stand_elements.hpp"
#include "grid/foliage_stand.hpp"
#include "grid/product_graph.hpp"

namespace sunfleck {

// How finely the field on cells is computed.
struct CellFieldEffort {
  ElementRule elements{};
  CellRule cells{};
  ClumpingEffort clumping{};
  DirectEffort direct{};
  GridEffort solver{};
};

// (F30) The light of each leaf of a stand as LeafField tells it, but by GridField: in a tenth of the time from nothing,
// and some per cent off. Products are kept from one call to the next: clumping follows from each kind's mesh, cells
// from these and where the trees stand, direct light from stand and suns' directions, solutions from these, optics,
// ground and sky; suns' colours change no product. Not to be used by several threads at once; it uses all cores itself.
class CellField {
 public:
  explicit CellField(const CellFieldEffort& effort = {});

  // As LeafField::setStand().
  void setStand(std::span<const std::shared_ptr<const TreeMesh>> kinds, const Stand& stand);

  // Throws InvalidInput as LeafField::solve() and GridField::solve() do; std::runtime_error("interrupted") when
  // `progress` ends it, which it asks after each iteration. Light that leaves cells through their sides counts as
  // downward in the balance, and with a period the suns' light on the ground as even over it.
  const FieldResult& solve(const FieldLighting& lighting, const Progress& progress = {});

  // (F31) As LeafField::groundLight(), on cells.
  std::vector<glm::vec3> groundLight(const GroundGrid& grid);

  std::vector<ProductCost> costs() const { return graph_.costs(); }  // clumping, cells, direct light, solutions

 private:
  static constexpr std::size_t kSources = kMostFieldSuns + 1, kSky = kMostFieldSuns;

  void makeCells();
  void makeSolution(std::size_t source, const Progress& progress);
  EnteringLight entering(std::size_t source, std::span<const std::size_t> bands) const;
  std::vector<FieldPart> parts() const;

  CellFieldEffort effort_;
  std::vector<std::shared_ptr<const TreeMesh>> meshes_;
  Stand stand_{.trees = {}};
  FieldLighting lighting_;

  ProductGraph graph_;
  ProductGraph::Product clumping_product_, cells_product_, direct_product_, solution_product_;

  std::vector<FieldElements> of_kinds_;  // of those that stand
  std::vector<float> clumping_;          // of each kind; 1 of those that do not stand
  StandElements elements_;
  std::vector<std::size_t> in_cells_;  // of each element, its number in the cells' medium
  std::optional<GridField> cells_;
  std::vector<float> ground_shares_;  // of these cells, once they are asked for
  std::array<DirectLight, kMostFieldSuns> direct_;
  std::array<std::array<FieldSolution, kBands>, kSources> solutions_;
  FieldResult result_;
};

}  // namespace sunfleck
