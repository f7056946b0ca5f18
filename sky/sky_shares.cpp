#include "sky/sky_shares.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numbers>

namespace sunfleck {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kLeastRows = 90;  // of patches, a degree each, that belong to one direction as a whole

}  // namespace

std::vector<glm::vec3> skyShares(const SkyMap& sky, std::span<const Direction> directions) {
  std::vector<std::size_t> up;
  for (std::size_t i = 0; i < directions.size(); ++i)
    if (directions[i].z > 0.f) up.push_back(i);
  std::vector<glm::vec3> shares(directions.size(), glm::vec3(0.f));
  if (up.empty()) return shares;

  // Cells of the sky, those of a coarse one cut into patches.
  const int cuts = (kLeastRows + sky.rows() - 1) / sky.rows();
  const int turns = (4 * kLeastRows + sky.columns() - 1) / sky.columns();
  const int rows = sky.rows() * cuts, columns = sky.columns() * turns;
  const double row_step = 0.5 * kPi / rows, column_step = 2. * kPi / columns;
  std::vector<glm::dvec3> sums(up.size(), glm::dvec3(0.));  // of radiance times solid angle
  std::vector<double> solid_angles(up.size(), 0.);
  std::vector<glm::vec2> turned;
  for (int column = 0; column < columns; ++column) {
    const double azimuth = double{sky.firstAzimuth()} + (column + 0.5) * column_step;
    turned.emplace_back(std::cos(azimuth), std::sin(azimuth));
  }
  for (int row = 0; row < rows; ++row) {
    const double zenith = (row + 0.5) * row_step;
    const double solid_angle = (std::cos(row * row_step) - std::cos((row + 1) * row_step)) * column_step;
    const auto sine = static_cast<float>(std::sin(zenith)), cosine = static_cast<float>(std::cos(zenith));
    const std::size_t first = static_cast<std::size_t>(row / cuts) * static_cast<std::size_t>(sky.columns());
    for (int column = 0; column < columns; ++column) {
      const glm::vec2 at = sine * turned[static_cast<std::size_t>(column)];
      const glm::vec3 to_sky(at, cosine);
      std::size_t nearest = 0;
      float most = -2.f;
      for (std::size_t i = 0; i < up.size(); ++i) {
        const float near = glm::dot(directions[up[i]], to_sky);
        nearest = near > most ? i : nearest;
        most = std::max(near, most);
      }
      solid_angles[nearest] += solid_angle;
      sums[nearest] += solid_angle * glm::dvec3(sky.radiance(first + static_cast<std::size_t>(column / turns)));
    }
  }
  glm::dvec3 whole(0.), of_shares(0.);
  for (std::size_t i = 0; i < up.size(); ++i) {
    whole += sums[i] / (2. * kPi);
    if (solid_angles[i] > 0.) sums[i] /= solid_angles[i];
    of_shares += sums[i] / static_cast<double>(up.size());
  }
  for (std::size_t i = 0; i < up.size(); ++i)
    for (int band = 0; band < kBands; ++band)
      if (of_shares[band] > 0.) shares[up[i]][band] = static_cast<float>(sums[i][band] * whole[band] / of_shares[band]);
  return shares;
}

}  // namespace sunfleck
