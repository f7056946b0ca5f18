#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/bounds.hpp"
#include "core/directions.hpp"
#include "field/line_exchange.hpp"
#include "field/stand_cells.hpp"

namespace sunfleck {

// The lines of an exchange by which light comes to a tree from outside, direction by direction.
struct OutsideLines {
  std::vector<std::uint32_t> first;  // of each direction, and the end
  std::vector<std::uint32_t> side;   // that each line comes to
};
OutsideLines outsideLines(const LineExchange& exchange);

// What light meets in the cells of a stand along one direction in which it travels.
struct CellsAlong {
  std::vector<float> extinction;  // of each slot [1/m]
  std::vector<float> radiance;    // that a cell without end would have, of each slot and band [1/sr]
};

// What lies about the cells.
struct AroundCells {
  // Radiance of the sky in which light travels in a direction, of each band [1/sr]; 0 where it rises.
  std::span<const float> sky;
  std::span<const float> ground;  // that the ground sends up, of each column of cells and band [1/sr]; empty: none
  std::span<const float> open;    // and beyond the cells, of each band; empty: none
};

// Lines of one direction to a tree, gathered by pixels across them: light is followed once for all lines of a pixel,
// from where they begin in the mean.
struct WallPixels {
  Direction along{0.f, 0.f, -1.f};     // in which the light travels
  std::vector<std::uint32_t> of_line;  // pixel of each line
  std::vector<glm::vec3> begin;        // of each pixel, relative to the tree's place [m]
};
//   centre  of the tree's elements, as it is turned, relative to its place [m]
//   sides   of elements that the lines come to
//   pixel   side of the pixels [m]
WallPixels wallPixels(std::span<const glm::vec3> centre, std::span<const std::uint32_t> sides, const Direction& along,
                      float pixel);

// A tree that light comes to.
struct LitTree {
  glm::vec3 position{0.f};     // [m]
  glm::ivec3 low{0}, size{0};  // cells that it lies in, whole periods not taken off
  std::vector<float> own;      // the share of each cell's leaves that are its own [1]
};

// (F29) Adds to `irradiance` what comes to a tree from beyond its own leaves in one direction: along its lines outward
// through what stands in the cells beside itself.
//   sides       that the lines of the pixels come to
//   per_line    irradiance of each element by radiance 1 on one of its lines [sr]
//   irradiance  of each side and band [1]
void addWallLight(const LitTree& tree, const SweepGrid& grid, const CellsAlong& cells, const AroundCells& around,
                  const WallPixels& pixels, std::span<const std::uint32_t> sides, std::span<const float> per_line,
                  std::size_t bands, std::span<float> irradiance);

}  // namespace sunfleck
