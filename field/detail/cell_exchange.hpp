#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>

#include "field/cell_piece.hpp"

// (F16) Light between the elements of a cell and the cell, compiled for several instruction sets; cellExchange() is the
// best that this machine has.
namespace sunfleck::detail {

inline constexpr std::size_t kMostFieldBands = 4;

// Directions by rows of 8 lanes: row r < pairs goes up and has its opposite in row pairs + r here.
struct ExchangeRows {
  std::size_t pairs;
  const float *x, *y, *z;  // of the directions that go up, 8 lanes a row
  const float* weight;     // [sr]
};

// Elements of all pieces; figures of a slot stand row after row, band after band, 8 lanes each.
struct ExchangeElements {
  const glm::vec3* normal;
  const float* fullness;  // 2 pi over the sum of weight times |n.s|, which makes either side's half of the sphere pi
};

struct CellExchange {
  // sigma of a cell, rows of one half of the sphere [1/m]; per_volume [1/m^3].
  void (*extinction)(const ExchangeRows& rows, const ExchangeElements& elements, const CellPiece* begin,
                     const CellPiece* end, float per_volume, float* sigma);
  // Q of a cell [radiance/m] from what elements send out: radiosity over pi, of front and of back, at
  // (element * 2 + side) * bands + band.
  void (*send)(const ExchangeRows& rows, const ExchangeElements& elements, const CellPiece* begin, const CellPiece* end,
               float per_volume, const float* radiance, std::size_t bands, float* source);
  // What the pieces of a cell receive from radiance: irradiance of front and back, at
  // ((piece - begin) * 2 + side) * bands + band.
  void (*receive)(const ExchangeRows& rows, const ExchangeElements& elements, const CellPiece* begin,
                  const CellPiece* end, const float* radiance, std::size_t bands, float* irradiance);
};

CellExchange cellExchange();

}  // namespace sunfleck::detail
