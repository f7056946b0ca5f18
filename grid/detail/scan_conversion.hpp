#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

// (D3) Which pixels of a picture triangles cover, compiled for several instruction sets; scanConversion() is the best
// that this machine has.
namespace sunfleck::detail {

// Square pixels that cover all triangles.
struct PixelGrid {
  glm::dvec2 corner;        // (right, up) of pixel (0, 0)'s outer corner [m]
  double pixels_per_metre;  // [1/m]
  int columns, rows;
};

// The pixels of a row whose centres lie in a triangle.
struct Span {
  std::uint32_t row, column, length;  // the first pixel, and how many
  float depth, slope;                 // at the first pixel's centre, and more with each further one [m]
  std::uint32_t triangle;
};

struct Scanned {
  std::size_t triangles, spans;
};

// Writes the spans of triangles, one after the other, as long as there is room for as many as a triangle may have, one
// for each row of pixels. A centre exactly on an edge is that of the triangle to its left or below, so that of two
// triangles that share an edge neither both claim, nor both miss, a pixel.
//   corners    of the triangles, (right, up, depth) [m]
//   triangles  `count` of them, as indices of `corners`
//   room       for spans, at least the number of rows
using ScanConversion = Scanned (*)(const PixelGrid& pixels, const glm::vec3* corners, const glm::uvec3* triangles,
                                   std::size_t count, Span* spans, std::size_t room);

ScanConversion scanConversion();

}  // namespace sunfleck::detail
