#include "pp_solver/slab_table.hpp"

#include <algorithm>
#include <cmath>

#include "pp_solver/detail/slab_table_data.hpp"
#include "pp_solver/detail/table_axis.hpp"

namespace sunfleck::pp {
namespace {

using detail::SlabTableData;
using detail::SplineWeights;
using detail::within;

// A place in a slab, its values made to lie in range, and the spline's weights there.
struct Place {
  float thickness, depth, mu0;
  SplineWeights along_thickness, along_depth, along_mu0;

  Place(const SlabTableData& data, float w, float z, float cosine)
      : thickness(within(0.f, w, static_cast<float>(data.max_thickness))),
        depth(within(0.f, z, thickness)),
        mu0(within(0.f, cosine, 1.f)),
        along_thickness(detail::ThicknessAxis(data.max_thickness).coordinate(thickness), data.nodes[0]),
        along_depth(detail::DepthAxis::coordinate(thickness, depth), data.nodes[1]),
        along_mu0(detail::cosineCoordinate(mu0), data.nodes[2]) {}

  // Calls row(weight, index) for the 64 rows of coefficients around the place; index as in SlabTableData::power.
  template <typename Row>
  void overRows(const SlabTableData& data, const Row& row) const {
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) {
        const float plane = along_thickness.weight[i] * along_depth.weight[j];
        const std::size_t line = (along_thickness.first + i) * data.padded(1) + along_depth.first + j;
        for (int k = 0; k < 4; ++k)
          row(plane * along_mu0.weight[k], line * data.padded(2) + along_mu0.first + static_cast<std::size_t>(k));
      }
  }
};

constexpr auto kLeast = static_cast<float>(detail::kLeastCosine);

}  // namespace

// (P12)
float SlabTable::radiance(float thickness, float depth, float mu0, float mu, float azimuth) const {
  const SlabTableData& data = *data_;
  const Place place(data, thickness, depth, mu0);
  if (!(place.thickness > 0.f) || !(place.mu0 > 0.f)) return 0.f;
  mu = within(-1.f, mu, 1.f);
  const bool upward = mu < 0.f;
  const float cosine = std::max(std::abs(mu), kLeast), incident = std::max(place.mu0, kLeast);
  const float cos_azimuth = std::isfinite(azimuth) ? std::cos(azimuth) : 1.f;

  const SplineWeights along_mu(detail::cosineCoordinate(cosine), data.nodes[3]);
  const std::size_t modes = static_cast<std::size_t>(data.modes), row_size = data.padded(3) * modes, span = 4 * modes;
  const float* half = data.source.data() + (upward ? data.sourceSize() / 2 : 0);
  float sums[4 * SlabTableData::kMostModes] = {};
  place.overRows(data, [&](float weight, std::size_t index) {
    const float* row = half + index * row_size + static_cast<std::size_t>(along_mu.first) * modes;
    for (std::size_t m = 0; m < span; ++m) sums[m] += weight * row[m];
  });
  for (std::size_t m = 0; m < modes; ++m) {
    float sum = 0.f;
    for (std::size_t l = 0; l < 4; ++l) sum += along_mu.weight[l] * sums[l * modes + m];
    sums[m] = sum;
  }

  const float rate = data.first.extinction(place.mu0) / incident, m = data.first.extinction(cosine) / cosine;
  const float path = upward ? place.thickness - place.depth : place.depth;
  const float multiply = -std::expm1(-m * path) * detail::cosineSeries(sums, data.modes, cos_azimuth);
  const float once =
      upward ? detail::onceUp(rate, m, place.depth, place.thickness) : detail::onceDown(rate, m, place.depth);
  return std::max(0.f, multiply) + data.first.into(upward ? -cosine : cosine, place.mu0, cos_azimuth) * once / cosine;
}

// (P12)
SlabTablePowers SlabTable::powers(float thickness, float depth, float mu0) const {
  const SlabTableData& data = *data_;
  const Place place(data, thickness, depth, mu0);
  const float incident = std::max(place.mu0, kLeast);
  SlabTablePowers powers{0.f, 0.f, std::exp(-place.depth * data.first.extinction(place.mu0) / incident)};
  if (!(place.thickness > 0.f) || !(place.mu0 > 0.f)) return powers;
  place.overRows(data, [&](float weight, std::size_t index) {
    powers.down += weight * data.power[2 * index];
    powers.up += weight * data.power[2 * index + 1];
  });
  powers.down = std::max(0.f, powers.down);
  powers.up = std::max(0.f, powers.up);
  return powers;
}

float SlabTable::maxThickness() const {
  return static_cast<float>(data_->max_thickness);
}
const SlabTableErrors& SlabTable::errors() const {
  return data_->errors;
}
const std::string& SlabTable::about() const {
  return data_->about;
}
std::array<int, 4> SlabTable::nodes() const {
  return data_->nodes;
}
int SlabTable::azimuthModes() const {
  return data_->modes;
}
int SlabTable::streams() const {
  return data_->streams;
}
std::size_t SlabTable::bytes() const {
  const detail::FirstScattering& first = data_->first;
  return sizeof(float) * (data_->source.size() + data_->power.size() + first.phase.size() + first.kernel.size() +
                          first.projection.size());
}

}  // namespace sunfleck::pp
