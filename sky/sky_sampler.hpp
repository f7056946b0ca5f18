#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "sky/sky_map.hpp"

namespace sunfleck {

// What a solid angle counts for: itself, or the light that goes from it through a plane across an axis, |to_sky[axis]|.
enum class SkyMeasure { solid_angle, through_x, through_y, through_z };

// Per band, the integral of the sky's radiance over a measure; through a plane, from both of its sides [1].
glm::dvec3 integral(const SkyMap& sky, SkyMeasure measure);

// A direction drawn from the sky.
struct SkySample {
  glm::vec3 to_sky{0.f};  // unit, z > 0
  std::size_t cell = 0;   // of the map
  float density = 0.f;    // of `to_sky` [1/sr]
};

// (R18) Directions to the sky with a density proportional to the weighted sum of its bands times a measure: exactly so,
// as the sky is constant in each of its cells and each measure has its inverse.
class SkySampler {
 public:
  //   sky      must outlive the sampler
  //   weights  of its bands, finite and >= 0 [1]
  SkySampler(const SkyMap& sky, const glm::dvec3& weights, SkyMeasure measure);

  // The integral of the weighted radiance over the measure; where it is 0 nothing can be drawn.
  double total() const { return total_; }
  // By two numbers in [0, 1), that map to directions continuously within each row of cells.
  SkySample sample(float u, float v) const;
  // Of the unit vector `to_sky`; 0 below the horizon [1/sr].
  float density(const glm::vec3& to_sky) const {
    return to_sky.z > 0.f && total_ > 0. ? densityIn(sky_->cell(to_sky), to_sky) : 0.f;
  }

 private:
  float densityIn(std::size_t cell, const glm::vec3& to_sky) const;

  const SkyMap* sky_;
  SkyMeasure measure_;
  double total_ = 0.;
  std::vector<double> rows_;    // cumulative shares of the rows, from 0 to 1 [1]
  std::vector<float> columns_;  // of each row, cumulative shares of its columns, from 0 to 1 [1]
  // Measure of a cell, which is that of its row times that of its column.
  std::vector<double> row_measure_, column_measure_;
};

}  // namespace sunfleck
