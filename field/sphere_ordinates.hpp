#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/directions.hpp"

namespace sunfleck {

// (F13) Directions that stand for the whole sphere, of equal weight, each with its opposite. They are held in octants:
// octant o, of eight, has x < 0 where bit 0 of o is set, y < 0 by bit 1, z < 0 by bit 2; 7 - o is its opposite. Each
// octant has the same number of rows of kLanes directions, short rows filled up with directions of weight 0, so that a
// row is swept by one vector. Direction i is lane i % kLanes of row i / kLanes; rows() / 8 of them per octant.
class SphereOrdinates {
 public:
  static constexpr std::size_t kLanes = 8;
  static constexpr int kOctants = 8;

  //   directions  how many, of weight > 0: even, 8 .. 2048; 64 fill all lanes
  explicit SphereOrdinates(int directions = 64);

  std::size_t rows() const { return directions_.size() / kLanes; }
  std::size_t rowsOfOctant() const { return rows() / kOctants; }
  std::size_t octant(std::size_t row) const { return row / rowsOfOctant(); }
  // The row of the opposite directions, lane by lane.
  std::size_t opposite(std::size_t row) const {
    return (kOctants - 1 - octant(row)) * rowsOfOctant() + row % rowsOfOctant();
  }
  std::size_t size() const { return directions_.size(); }  // with those of weight 0
  const Direction& direction(std::size_t i) const { return directions_[i]; }
  float weight(std::size_t i) const { return weights_[i]; }  // [sr]; 4 pi in all
  // Sum of weight times |cosine to the axis| over the half of the sphere beyond it: pi for exact ordinates.
  double halfFlux(int axis) const { return half_flux_[static_cast<std::size_t>(axis)]; }

 private:
  std::vector<Direction> directions_;
  std::vector<float> weights_;
  std::array<double, 3> half_flux_{};
};

}  // namespace sunfleck
