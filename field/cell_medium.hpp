#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/stand.hpp"
#include "core/tree_mesh.hpp"
#include "field/cell_piece.hpp"
#include "field/elements.hpp"
#include "field/sweep.hpp"

namespace sunfleck {

// A tree whose elements are put into cells.
struct PlacedElements {
  const TreeMesh* mesh;
  const FieldElements* elements;
  Placement placement{};
};

struct CellRule {
  int cells = 16;          // along the longest side of a tree, the smallest of the trees': 1 .. 256
  float least_side = 0.f;  // of a cell [m]
  // Height of the ground, where the cells begin [m]; none: they begin with the leaves.
  std::optional<float> ground{};
};

// (F15) The leaves and the wood of trees as a medium in cells. An element's area is shared among the cells it lies in,
// and these shares serve both ways, for the light that it takes from the cells and for that which it sends into them,
// so that none is lost or made. Elements are numbered tree after tree.
struct CellMedium {
  SweepGrid grid;

  std::vector<CellPiece> pieces;             // cell after cell, in the order of elements
  std::vector<std::uint32_t> first_piece;    // of each slot, and the end
  std::vector<std::uint32_t> of_element;     // numbers of pieces, element after element
  std::vector<std::uint32_t> first_of;       // of each element in of_element, and the end
  std::vector<glm::vec3> normal;             // of each element, of its front; 0: leaves turned every way
  std::vector<float> area;                   // of each element, as in its pieces [m^2]
  std::vector<std::uint32_t> material;       // of each element: twice the kind of its tree; one more for wood
  std::vector<std::uint32_t> first_element;  // of each tree, and the end
};

//   period  of the trees, where they repeat
// Throws InvalidInput on no tree, as requireFinished does, on cells out of their range, and on more cells or pieces
// than memory has room for.
CellMedium cellMedium(std::span<const PlacedElements> trees, const CellRule& rule = {},
                      const std::optional<glm::vec2>& period = std::nullopt);

// Leaves turned every way that fill a cell evenly.
struct CellLeaves {
  std::uint32_t cell, kind;  // of the grid, of tree
  float area;                // one-sided [m^2], > 0
};

// (F20) A medium of leaves too small and too many to be told apart: those of a kind in a cell are one element. `grid`
// needs no slots yet. Throws InvalidInput on a cell that is none, and an area that is not above 0.
CellMedium turbidMedium(SweepGrid grid, std::span<const CellLeaves> leaves);

}  // namespace sunfleck
