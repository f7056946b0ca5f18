#include "sky/sky_map.hpp"

#include <algorithm>
#include <boost/uuid/name_generator_sha1.hpp>
#include <boost/uuid/nil_generator.hpp>
#include <boost/uuid/uuid.hpp>
#include <boost/uuid/uuid_io.hpp>
#include <cmath>
#include <numbers>

#include "core/require.hpp"

namespace sunfleck {

SkyMap::SkyMap(int rows, int columns, float first_azimuth, std::vector<glm::vec3> radiance)
    : rows_(rows), columns_(columns), first_azimuth_(first_azimuth), radiance_(std::move(radiance)) {
  const std::string sides = "from 1 to " + std::to_string(kMostSide);
  require(rows >= 1 && rows <= kMostSide, "rows of the sky", rows, sides);
  require(columns >= 1 && columns <= kMostSide, "columns of the sky", columns, sides);
  require(std::abs(first_azimuth) <= 100.f, "first azimuth of the sky", first_azimuth, "in [-100, 100] rad");
  const std::size_t cells = static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
  require(radiance_.size() == cells, "number of radiances of the sky", radiance_.size(),
          "rows times columns, " + std::to_string(cells));
  const double step = 0.5 * std::numbers::pi / rows;
  for (int row = 0; row < rows; ++row) {
    glm::dvec3 sum(0.);
    for (std::size_t i = 0; i < static_cast<std::size_t>(columns); ++i) {
      const glm::vec3& value = radiance_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + i];
      for (int band = 0; band < kBands; ++band)
        require(value[band] >= 0.f && value[band] <= kMostRadiance, "radiance of the sky", value[band], "in [0, 1e6]");
      sum += value;
    }
    // The integral of cosine over a row, 2 pi (sin^2 b - sin^2 a) / 2 = pi sin(b - a) sin(b + a), per column.
    irradiance_ += std::numbers::pi / columns * std::sin(step) * std::sin((2 * row + 1) * step) * sum;
  }
}

std::size_t SkyMap::cell(const glm::vec3& to_sky) const {
  constexpr float kInverseTurn = 0.5f * std::numbers::inv_pi_v<float>;
  int row = 0, column = 0;
  if (rows_ > 1) {
    const float zenith = std::acos(std::min(to_sky.z, 1.f)) * (2.f * std::numbers::inv_pi_v<float>);
    row = std::min(static_cast<int>(zenith * static_cast<float>(rows_)), rows_ - 1);
  }
  if (columns_ > 1) {
    const float turn = (std::atan2(to_sky.y, to_sky.x) - first_azimuth_) * kInverseTurn;
    column = std::min(static_cast<int>((turn - std::floor(turn)) * static_cast<float>(columns_)), columns_ - 1);
  }
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
}

SkyMap SkyMap::scaled(const glm::dvec3& factors) const {
  std::vector<glm::vec3> radiance = radiance_;
  for (glm::vec3& value : radiance) value = glm::vec3(glm::dvec3(value) * factors);
  return SkyMap(rows_, columns_, first_azimuth_, std::move(radiance));
}

std::string SkyMap::hash() const {
  const float head[] = {static_cast<float>(rows_), static_cast<float>(columns_), first_azimuth_};
  const auto of_head = boost::uuids::name_generator_sha1(boost::uuids::nil_uuid())(head, sizeof(head));
  return boost::uuids::to_string(
      boost::uuids::name_generator_sha1(of_head)(radiance_.data(), radiance_.size() * sizeof(radiance_[0])));
}

}  // namespace sunfleck
