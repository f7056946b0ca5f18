#pragma once

#include <cstdint>

namespace sunfleck {

// What of an element lies in a cell.
struct CellPiece {
  std::uint32_t element;
  float area;  // that is seen from either side [m^2]: of wood, whose other side is within, half of its surface
};

}  // namespace sunfleck
