#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/bounds.hpp"
#include "core/progress.hpp"
#include "core/shared_progress.hpp"
#include "core/stand.hpp"
#include "core/tree_mesh.hpp"
#include "field/grid_field.hpp"
#include "field/leaf_field.hpp"
#include "field/line_exchange.hpp"
#include "field/stand_cells.hpp"
#include "field/stand_sun.hpp"
#include "field/wall_light.hpp"

namespace sunfleck {

// How finely the field of a large stand is computed.
struct LargeStandEffort {
  ElementRule elements;
  ExchangeEffort exchange;
  SolverEffort solver;
  GridEffort cells;
  int cells_along = 8;       // cells along the longest side of the smallest tree, where these are few enough
  double most_cells = 8e5;   // that hold something, of all trees
  double most_lines = 8e8;   // of a sun's light, that all trees' pictures take together
  float pixels = 128.f;      // of such a picture, on an element of mean area that faces the sun, where these are few
                             // enough [1]
  double most_memory = 4e9;  // [byte]
};

struct LargeStandStats {
  float cell_side = 0.f;        // [m]
  std::size_t cells = 0;        // that hold something
  std::size_t elements = 0;     // in them
  int cell_iterations = 0;      // of the solution on cells, the most of a band
  double cell_error = 0.;       // its bound
  double memory = 0.;           // that was foreseen [byte]
  std::vector<float> clumping;  // of each kind
};

// (F28), (F29) The light of the leaves of some trees of a stand of very many. The whole stand is solved in coarse
// cells; what comes from there to the trees asked for is the light around each of them, which is then solved leaf by
// leaf along lines that all trees of its kind share. Nothing is kept of the leaves of other trees. Products are kept
// from one call to the next as far as what they follow from is the same. Not to be used by several threads at once; it
// uses all cores itself. The same to the bit for any number of threads.
class LargeStandField {
 public:
  explicit LargeStandField(const LargeStandEffort& effort = {});
  ~LargeStandField();

  // Throws InvalidInput as LeafField::setStand() does.
  void setStand(std::span<const std::shared_ptr<const TreeMesh>> kinds, const Stand& stand);

  // The field of the trees listed: those of the result's trees that are not are empty. Its balance is that of the whole
  // stand in cells, per band. Throws InvalidInput as LeafField::solve() does, and before work begins where memory would
  // not suffice, with the figure; std::runtime_error("interrupted") when `progress`, asked after each axis of lines,
  // iteration, tree or tile of the suns' pictures, ends it: what was made till then stays, and it may be asked again.
  //   seen  numbers of trees, each once
  //   far   those of which cells suffice, as they are too far to see leaves
  const FieldResult& solve(const FieldLighting& lighting, std::span<const std::size_t> seen,
                           std::span<const std::size_t> far = {}, const Progress& progress = {});

  // Of a tree that is far: irradiance of the front and the back of each of its groups of leaves by all but the suns'
  // direct light, per band [1]; and of each kind the side of a group, 2 group or 2 group + 1, that a side of an element
  // belongs to. Empty for others.
  std::span<const glm::vec3> farSides(std::size_t tree) const { return far_sides_[tree]; }
  std::span<const std::uint32_t> farSidesOf(std::uint32_t kind) const;
  const FieldElements& elements(std::uint32_t kind) const;  // of a kind of which there is a tree

  const LargeStandStats& stats() const { return stats_; }
  std::vector<ProductCost> costs() const;

 private:
  struct Kind;
  struct Turn;
  struct Lit;
  struct Sent;

  void makeKinds(const Progress& progress);
  void makeTurns(const Progress& progress);
  void makeCells(const Progress& progress);
  double lineArea() const;
  Bounds boxOf(std::size_t kind) const;
  double pictureBytes(const FieldLighting& lighting) const;
  const TreePicture& pictureOf(Turn& turn, std::size_t sun) const;
  void makeSuns(std::span<const std::size_t> seen, const Progress& progress);
  void solveCells(const Progress& progress);
  void solveTrees(std::span<const std::size_t> seen, const Progress& progress);
  Sent sent() const;
  const std::vector<Direction>& exchangeDirections() const;
  CellsAlong cellsAlong(const Direction& s, std::span<const float> sent) const;
  LitTree litTree(std::size_t number) const;
  std::vector<std::vector<float>> lightAtWalls(std::span<const std::size_t> now, const Sent& sent,
                                               SharedProgress& progress);
  std::vector<float> directLight(std::size_t tree, std::size_t sun) const;
  std::vector<std::vector<float>> scatteredOnce(std::span<const std::size_t> now, SharedProgress& progress) const;
  void solveAlongLines(std::span<const std::size_t> now, std::span<const std::vector<float>> around,
                       SharedProgress& progress);
  void tellFar(std::span<const std::size_t> far, SharedProgress& progress);
  void requireMemory(const FieldLighting& lighting, std::span<const std::size_t> seen,
                     std::span<const std::size_t> far);

  LargeStandEffort effort_;
  Stand stand_{.trees = {}};
  std::vector<std::shared_ptr<const TreeMesh>> meshes_;
  std::optional<FieldLighting> lighting_;
  std::vector<std::unique_ptr<Kind>> kinds_;
  std::vector<std::unique_ptr<Turn>> turns_;
  std::vector<std::size_t> turn_of_tree_;
  // Steps of solve() that are made, in their order: each follows from those before it.
  enum Step { kNothing, kKindsMade, kCellsMade, kSunsMade, kCellsSolved, kTreesSolved, kFarTold };
  void makeStep(Step step, std::span<const std::size_t> seen, std::span<const std::size_t> far,
                const Progress& progress);
  Step made_ = kNothing;
  std::vector<ClusteredTree> trees_;
  std::optional<StandMedium> medium_;
  std::optional<GridField> cells_;
  std::unique_ptr<Lit> lit_;
  std::vector<std::size_t> seen_, far_;  // that the result is of
  std::vector<std::vector<glm::vec3>> far_sides_;
  FieldResult result_;
  LargeStandStats stats_;
  std::vector<ProductCost> costs_;
};

}  // namespace sunfleck
