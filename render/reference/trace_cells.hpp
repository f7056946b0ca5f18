#pragma once

#include <cstddef>
#include <glm/vec3.hpp>

#include "render/reference/ray_scene.hpp"

namespace sunfleck {

// Cubic cells that fill the traced box of a scene, from its low corner on. The last of a row may reach beyond the box;
// in x and y of a periodic stand it ends with the period.
class TraceCells {
 public:
  // As many, at two sums for each band, as one run keeps: 4 million for one band.
  static constexpr std::size_t kMostSums = 8'000'000;

  //   side  [m], > 0
  // Throws InvalidInput on a side that is not finite and above 0, or makes more cells than `bands` may have.
  TraceCells(const RayScene& scene, double side, std::size_t bands);

  double side() const { return side_; }
  std::size_t count() const { return counts_.x * counts_.y * counts_.z; }
  // Number of the cell that holds a point of the box, which is told about the scene's origin [m].
  std::size_t at(const glm::vec3& point) const;
  glm::uvec3 place(std::size_t cell) const;  // of a cell along x, y and z
  glm::dvec3 size(std::size_t cell) const;   // of a cell [m]
  glm::dvec3 corner() const;                 // low corner of the first cell, in the stand's coordinates [m]

 private:
  glm::vec3 low_, high_;  // of the traced box about the scene's origin [m]
  glm::vec3 origin_;      // of the scene, in the stand's coordinates [m]
  bool periodic_;
  double side_;
  float per_length_;  // cells per metre
  glm::vec<3, std::size_t> counts_{};
};

}  // namespace sunfleck
