#include "render/compare/slab_error_cells.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>

#include "core/random.hpp"

namespace sunfleck {
namespace {

using spp::MapAxis;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kThin = 1e-3;    // stands for thickness 0: errors go to 0 there
constexpr double kThick = 1000.;  // stands for the thickest finite slabs
constexpr int kMorePlaces = 12;   // in each cell, for powers alone, which take a hundredth of the time
constexpr int kMoreDepths = 8;
constexpr double kDeep = 0.49;  // relative depth that stands for the bottomless rest of a half space

enum Axis : std::size_t { kLost, kAsymmetry, kThickness, kDepth, kMu0, kAxes };

// A value within a cell by the share of the way through it; the cells of 1 - omega and of thickness are as many
// decades.
double within(const MapAxis& axis, std::size_t which, int cell, double share) {
  const auto [low, high] = axis.range(cell);
  if (low == high) return low;
  if ((which == kLost || which == kThickness) && low > 0. && std::isfinite(high))
    return low * std::pow(high / low, share);
  return std::isinf(high) ? low / (1. - share) : low + share * (high - low);
}

// A value at which errors are measured, and the cells they count for.
struct Sample {
  double value;
  std::vector<int> cells;
};

// Corners of the cells; no light is scattered where 1 - omega = 1, and all tiers are exact but for rounding.
std::vector<Sample> corners(const MapAxis& axis, std::size_t which) {
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < axis.edges().size(); ++i) {
    const double edge = axis.edges()[i];
    if (which == kLost && edge == 1.) continue;
    samples.push_back({which == kThickness && edge == 0. ? kThin : edge, axis.around(i)});
    if (which == kThickness && std::isinf(edge)) samples.push_back({kThick, {axis.cell(kThick)}});
  }
  return samples;
}

std::vector<Sample> middles(const MapAxis& axis, std::size_t which) {
  std::vector<Sample> samples;
  for (int cell = 0; cell < axis.cells(); ++cell) samples.push_back({within(axis, which, cell, 0.5), {cell}});
  return samples;
}

// Depths within each cell, evenly spread.
std::vector<Sample> manyWithin(const MapAxis& axis, std::size_t which) {
  std::vector<Sample> samples;
  for (int cell = 0; cell < axis.cells(); ++cell) {
    const bool edge = axis.range(cell)[0] == axis.range(cell)[1];
    for (int i = 0; i < (edge ? 1 : kMoreDepths); ++i)
      samples.push_back({within(axis, which, cell, (i + 0.5) / kMoreDepths), {cell}});
  }
  return samples;
}

TierErrorSettings settingsFor(double asymmetry) {
  if (std::abs(asymmetry) < 0.6) return {.streams = 32, .cosines = 6, .azimuths = 6};
  return {.streams = 40, .cosines = 8, .azimuths = 8};
}

class Cells {
 public:
  Cells() : axes_(spp::particleAxes()) {
    std::size_t cells = 1;
    for (const MapAxis& axis : axes_) cells *= static_cast<std::size_t>(axis.cells());
    largest_.assign(cells * spp::SlabErrorMap::columns(), 0.);
    for (auto make : {corners, middles}) {
      const auto of = [&](Axis axis) { return make(axes_[axis], axis); };
      const auto depths = std::make_shared<const std::vector<Sample>>(of(kDepth));
      for (const Sample& lost : of(kLost))
        for (const Sample& asymmetry : of(kAsymmetry))
          for (const Sample& thickness : of(kThickness))
            for (const Sample& mu0 : of(kMu0)) slabs_.push_back({lost, asymmetry, thickness, mu0, depths, true});
    }
    addRandom();
  }

  std::size_t slabs() const { return slabs_.size(); }

  void measure(std::size_t index) {
    const Slab& slab = slabs_[index];
    const pp::SlabCase given{.asymmetry = slab.asymmetry.value,
                             .albedo = 1. - slab.lost.value,
                             .thickness = slab.thickness.value,
                             .mu0 = slab.mu0.value};
    std::vector<const Sample*> samples;
    std::vector<double> depths;
    for (const Sample& sample : *slab.depths) {
      if (std::isinf(given.thickness) && sample.value > 0.5) continue;
      samples.push_back(&sample);
      depths.push_back(
          spp::depthAt(std::isinf(given.thickness) ? std::min(sample.value, kDeep) : sample.value, given.thickness));
    }
    TierErrorSettings settings = settingsFor(given.asymmetry);
    if (!slab.radiance) settings.cosines = 0;
    const std::vector<TierErrors> errors = slabTierErrors(given, depths, settings);
    const std::scoped_lock lock(adding_);
    for (std::size_t d = 0; d < samples.size(); ++d)
      for (const int a : slab.lost.cells)
        for (const int b : slab.asymmetry.cells)
          for (const int c : slab.thickness.cells)
            for (const int e : slab.mu0.cells)
              for (const int z : samples[d]->cells) add({a, b, c, z, e}, {&errors[d * tiers_.size()], tiers_.size()});
  }

  spp::SlabErrorMap map() const {
    std::vector<std::uint8_t> codes;
    for (const double error : largest_) codes.push_back(spp::SlabErrorMap::code(error));
    return {axes_, std::move(codes)};
  }

 private:
  struct Slab {
    Sample lost, asymmetry, thickness, mu0;
    std::shared_ptr<const std::vector<Sample>> depths;
    bool radiance;  // is measured too
  };

  // Powers at random places within each cell.
  void addRandom() {
    const auto depths = std::make_shared<const std::vector<Sample>>(manyWithin(axes_[kDepth], kDepth));
    Random random(1, 0);
    const auto in = [&](Axis axis, int cell) {
      return Sample{within(axes_[axis], axis, cell, random.uniformDouble()), {cell}};
    };
    for (int a = 0; a < axes_[kLost].cells(); ++a)
      for (int b = 0; b < axes_[kAsymmetry].cells(); ++b)
        for (int c = 0; c < axes_[kThickness].cells(); ++c)
          for (int e = 0; e < axes_[kMu0].cells(); ++e)
            for (int i = 0; i < kMorePlaces; ++i)
              slabs_.push_back({in(kLost, a), in(kAsymmetry, b), in(kThickness, c), in(kMu0, e), depths, false});
  }

  void add(std::array<int, kAxes> at, std::span<const TierErrors> errors) {
    std::size_t cell = 0;
    for (std::size_t i = 0; i < kAxes; ++i)
      cell = cell * static_cast<std::size_t>(axes_[i].cells()) + static_cast<std::size_t>(at[i]);
    for (std::size_t t = 0; t < tiers_.size(); ++t)
      for (std::size_t q = 0; q < spp::kSlabQuantities; ++q) {
        double& largest = largest_[cell * spp::SlabErrorMap::columns() +
                                   spp::SlabErrorMap::column(tiers_[t], static_cast<spp::SlabQuantity>(q))];
        const bool radiance = static_cast<spp::SlabQuantity>(q) == spp::SlabQuantity::kRadiance;
        largest = std::max(largest, (radiance ? kRadianceMargin : kPowerMargin) * errors[t][q]);
      }
  }

  std::vector<MapAxis> axes_;
  std::span<const spp::SlabTier> tiers_ = spp::slabTiers();
  std::vector<Slab> slabs_;
  std::vector<double> largest_;
  std::mutex adding_;
};

template <typename Work>
void forAll(std::size_t count, const Progress& progress, const Work& work) {
  std::mutex telling;
  std::size_t done = 0;
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    work(i);
    const std::scoped_lock lock(telling);
    goOn(progress, static_cast<double>(++done) / static_cast<double>(count));
  });
}

}  // namespace

spp::SlabErrorMap measuredParticleErrors(const Progress& progress) {
  Cells cells;
  forAll(cells.slabs(), progress, [&](std::size_t i) { cells.measure(i); });
  return cells.map();
}

std::vector<CheckedPlace> checkedPlaces(int count, unsigned seed, const Progress& progress) {
  const std::vector<MapAxis> axes = spp::particleAxes();
  std::vector<CheckedPlace> places(static_cast<std::size_t>(count));
  forAll(places.size(), progress, [&](std::size_t i) {
    Random random(seed, i);
    std::array<double, kAxes> values{};
    for (std::size_t a = 0; a < kAxes; ++a) {
      const int cell = std::min(static_cast<int>(random.uniformDouble() * axes[a].cells()), axes[a].cells() - 1);
      values[a] = within(axes[a], a, cell, random.uniformDouble());
    }
    if (std::isinf(values[kThickness])) values[kDepth] *= kDeep;
    const double depth = spp::depthAt(values[kDepth], values[kThickness]);
    const pp::SlabCase slab{.asymmetry = values[kAsymmetry],
                            .albedo = 1. - values[kLost],
                            .thickness = values[kThickness],
                            .mu0 = values[kMu0]};
    places[i] = {{slab.asymmetry, slab.albedo, slab.thickness, depth, slab.mu0},
                 slabTierErrors(slab, std::array{depth}, {.streams = 64, .cosines = 16, .azimuths = 20})};
  });
  return places;
}

}  // namespace sunfleck
