#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "grid/cell_grid.hpp"
#include "grid/deep_opacity_map.hpp"
#include "grid/optical_depth.hpp"

namespace sunfleck {

// (D4) What the cells of a stand read of one tree along one axis, for light that travels along it or against it.
class TreeDepths {
 public:
  // Of the tree that `map` and `grid` were made of, along the map's axis.
  //   seen_from  sides of the cells that this tree will be seen from [m]; 0: from none
  TreeDepths(const CellGrid& grid, const DeepOpacityMap& map, std::span<const float> seen_from);

  const Axes& axes() const { return axes_; }

  // Mean number of the tree's leaf crossings from each of its own cells outward along the axis, and against it: over
  // the cell's volume, sampled by the map's lines through it, exact along each. In steps; for all cells, active or not.
  std::span<const FixedDepth> beyond() const { return beyond_; }
  std::span<const FixedDepth> before() const { return before_; }
  // (D13) Share of each of its own cells from which the tree's wood does not hide what lies outward along the axis, and
  // against it [1]. Empty unless the map tells of the last wood.
  std::span<const float> openBeyond() const { return open_beyond_; }
  std::span<const float> openBefore() const { return open_before_; }
  // Number of leaf crossings on the whole line through a point beside the tree, (right, up) of the map [m], the mean
  // over lines through a cell around it [step].
  //   receiver_cells  which of `seen_from` that cell is
  std::uint32_t thickness(std::size_t receiver_cells, glm::vec2 point) const {
    return pictures_[receiver_cells].at(point);
  }
  // Adds what this tree, displaced by `displacement` [m] from the tree of `receiver`, puts before the receiver's active
  // cells, `times` times: -1 takes it away again. `receiver` must have the same axes.
  //   grid, receiver_grid  of this tree and of the receiver
  //   receiver_cells       which of `seen_from` the receiver's cells are
  //   beyond, before       sums over trees for the receiver's active cells [step]
  void addTo(const CellGrid& grid, const TreeDepths& receiver, const CellGrid& receiver_grid,
             std::size_t receiver_cells, const glm::vec3& displacement, std::int32_t times,
             std::span<std::int32_t> beyond, std::span<std::int32_t> before) const;

  std::size_t memoryBytes() const;

 private:
  // Number of leaf crossings on the whole line through a point beside the tree, the mean over the lines through a cell
  // around the point.
  struct Picture {
    glm::vec2 corner{0.f};              // (right, up) of the centre of pixel (0, 0) [m]
    float per_pixel = 0.f;              // [1/m]
    glm::vec2 last{0.f};                // column and row of the last pixel
    std::size_t width = 0;              // [pixel]
    std::vector<FixedDepth> thickness;  // at the pixels' centres; the outermost are 0

    // In steps, at (right, up) [m].
    std::uint32_t at(glm::vec2 place) const;
  };
  struct Means {
    float beyond, before;  // crossings [1]
  };
  struct Depths {
    FixedDepth beyond, before;
  };
  static Picture pictureOf(const DeepOpacityMap& map, float seen_side);
  std::vector<Means> walkLines(const CellGrid& grid, const DeepOpacityMap& map);
  std::vector<Depths> overCells(std::vector<Means> means, float seen_side) const;
  // Means over a cell around a point among the tree's cells or near them, interpolated.
  Depths within(std::size_t receiver_cells, glm::vec3 point) const;

  Axes axes_;
  std::vector<FixedDepth> beyond_, before_;
  std::vector<float> open_beyond_, open_before_;
  std::vector<Picture> pictures_;               // as seen from each kind of cells
  CellGrid parts_;                              // parts of the cells, and as many around them; all are told of
  std::vector<std::vector<Depths>> within_;     // at the centres of these parts, for each kind of cells
  std::vector<glm::vec2> cells_;                // (right, up) of the centres of the tree's active cells [m]
  glm::vec2 cells_low_{0.f}, cells_high_{0.f};  // their box
};

}  // namespace sunfleck
