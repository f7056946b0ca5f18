#include "leaves/tissue_by_thickness.hpp"

#include <algorithm>
#include <cmath>

#include "core/require.hpp"
#include "leaves/slab_leaf.hpp"
#include "pp_solver/slab_batch.hpp"

namespace sunfleck {
namespace {

constexpr int kStreams = 32;  // as slabLeaf()
constexpr double kThinnest = 1e-12;
constexpr double kStep = 0.02;  // of log(1 + optical thickness): cubics between are off by less than 2e-6
constexpr std::size_t kLeastRows = 4;

}  // namespace

TissueByThickness::TissueByThickness(const glm::dvec3& absorption, const glm::dvec3& scattering, double thinnest,
                                     double thickest) {
  for (int band = 0; band < kBands; ++band)
    validate(LeafTissue{.absorption = absorption[band], .scattering = scattering[band], .thickness = 0.});
  require(thinnest >= 0. && thinnest <= thickest, "thinnest", thinnest, "in [0, thickest] mm");
  require(thickest <= 2000., "thickest", thickest, "at most 2000 mm");
  // In the logarithm, thin and thick tissue and bands of any extinction are as smooth as each other.
  scale_ = 1e-3;
  for (int band = 0; band < kBands; ++band) scale_ = std::max(scale_, absorption[band] + scattering[band]);
  first_ = std::log1p(scale_ * thinnest);
  last_ = std::log1p(scale_ * thickest);
  rows_.resize(std::max(static_cast<std::size_t>(std::ceil((last_ - first_) / kStep)) + 1, kLeastRows));
  std::vector<pp::SlabCase> slabs;
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    const double thickness = std::expm1(first_ + kStep * static_cast<double>(row)) / scale_;
    for (int band = 0; band < kBands; ++band) {
      const double all = absorption[band] + scattering[band];
      slabs.push_back({.asymmetry = 0.,
                       .albedo = all > 0. ? std::min(scattering[band] / all, 1.) : 0.,
                       .thickness = std::max(all * thickness, kThinnest),
                       .mu0 = 1.});
    }
  }
  std::vector<pp::SlabFluxes> fluxes(slabs.size());
  pp::solveSlabs(slabs, fluxes, kStreams);
  for (std::size_t row = 0; row < rows_.size(); ++row)
    for (std::size_t band = 0; band < kBands; ++band) {
      rows_[row][band] = fluxes[row * kBands + band].reflectance;
      rows_[row][kBands + band] = fluxes[row * kBands + band].transmittance;
    }
}

TissueBands TissueByThickness::at(double thickness) const {
  const double asked = std::log1p(scale_ * std::max(thickness, 0.));
  const double place = (std::clamp(asked, first_, last_) - first_) / kStep;
  const auto highest = static_cast<double>(rows_.size() - kLeastRows);
  const double from = std::clamp(std::floor(place) - 1., 0., highest);
  // Lagrange's cubic through four rows, x from the second on.
  const double x = place - from - 1., a = x + 1., b = x - 1., c = x - 2.;
  const std::array weights{-x * b * c / 6., a * b * c / 2., -a * x * c / 2., a * x * b / 6.};
  const auto* row = rows_.data() + static_cast<std::size_t>(from);
  std::array<double, kValues> sums{};
  for (std::size_t i = 0; i < kLeastRows; ++i)
    for (std::size_t value = 0; value < kValues; ++value) sums[value] += weights[i] * row[i][value];
  TissueBands bands;
  for (std::size_t band = 0; band < kBands; ++band) {
    bands.reflectance[band] = std::clamp(sums[band], 0., 1.);
    bands.transmittance[band] = std::clamp(sums[kBands + band], 0., 1. - bands.reflectance[band]);
  }
  return bands;
}

}  // namespace sunfleck
