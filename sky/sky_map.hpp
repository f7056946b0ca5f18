#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "core/leaf_optics.hpp"

namespace sunfleck {

// (R17) What the sky sends down: its radiance per band (red, green, blue), relative to a sun that gives irradiance 1 to
// a plane that faces it [1/sr]. Piecewise constant on cells of the upper hemisphere: rows even in the zenith angle, the
// first around the zenith and the last down to the horizon; columns even in the azimuth, from `first_azimuth` on in the
// sense from +x towards +y. Below the horizon there is no sky.
class SkyMap {
 public:
  //   radiance       of rows * columns cells, row by row, in [0, kMostRadiance] [1/sr]
  //   first_azimuth  where the first column begins [rad], in [-100, 100]
  // Throws InvalidInput on a number of rows or columns that is not in 1 .. kMostSide, another number of radiances or a
  // value out of its range.
  SkyMap(int rows, int columns, float first_azimuth, std::vector<glm::vec3> radiance);

  static constexpr int kMostSide = 16'384;
  static constexpr float kMostRadiance = 1e6f;  // beyond, squares would overflow the sums of Monte Carlo

  int rows() const { return rows_; }
  int columns() const { return columns_; }
  float firstAzimuth() const { return first_azimuth_; }

  // Towards a unit vector; 0 where it points below the horizon.
  glm::vec3 radiance(const glm::vec3& to_sky) const {
    return to_sky.z > 0.f ? radiance_[cell(to_sky)] : glm::vec3(0.f);
  }
  const glm::vec3& radiance(std::size_t cell) const { return radiance_[cell]; }
  std::size_t cell(const glm::vec3& to_sky) const;  // row * columns() + column, of a unit vector with z > 0

  glm::dvec3 irradiance() const { return irradiance_; }  // of a horizontal plane [1]
  // The same sky with the radiance of each band times a factor, finite and >= 0.
  SkyMap scaled(const glm::dvec3& factors) const;
  // Of all that tells one sky from another, as text.
  std::string hash() const;

 private:
  int rows_, columns_;
  float first_azimuth_;
  std::vector<glm::vec3> radiance_;
  glm::dvec3 irradiance_{0.};
};

}  // namespace sunfleck
