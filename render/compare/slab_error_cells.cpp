#include "render/compare/slab_error_cells.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>

#include "core/random.hpp"

namespace sunfleck {
namespace {

using spp::MapAxis;
using spp::MapKind;

constexpr double kThin = 1e-3;    // stands for thickness 0: errors go to 0 there
constexpr double kThick = 1000.;  // stands for the thickest finite slabs
constexpr int kMoreDepths = 8;    // in each cell, for powers alone, which take a hundredth of the time
constexpr double kDeep = 0.49;    // relative depth that stands for the bottomless rest of a half space
constexpr std::size_t kLost = 0;  // the first of spp::mapAxes()

int morePlaces(MapKind kind) {
  return kind == MapKind::kLeaves ? 4 : 12;
}

TierErrorSettings settingsFor(const spp::MappedMedium& medium) {
  const auto* particles = std::get_if<spp::MappedParticles>(&medium);
  if (!particles) return {.streams = 32, .cosines = 0};
  if (std::abs(particles->asymmetry) < 0.6) return {.streams = 32, .cosines = 6, .azimuths = 6};
  return {.streams = 40, .cosines = 8, .azimuths = 8};
}

// A value at which errors are measured, and the cells they count for.
struct Sample {
  double value;
  std::vector<int> cells;
};
using Point = std::vector<double>;  // a value on each axis

// The axes of one map, and values on them.
class Axes {
 public:
  explicit Axes(MapKind kind) : axes_(spp::mapAxes(kind)) {}
  std::size_t size() const { return axes_.size(); }
  std::size_t thickness() const { return size() - 3; }
  std::size_t depth() const { return size() - 2; }
  const std::vector<MapAxis>& all() const { return axes_; }

  // A value within a cell by the share of the way through it; the cells of 1 - omega and of thickness are as many
  // decades.
  double within(std::size_t axis, int cell, double share) const {
    const auto [low, high] = axes_[axis].range(cell);
    if (low == high) return low;
    if ((axis == kLost || axis == thickness()) && low > 0. && std::isfinite(high))
      return low * std::pow(high / low, share);
    return std::isinf(high) ? low / (1. - share) : low + share * (high - low);
  }

  // Corners of the cells; no light is scattered where 1 - omega = 1, and all tiers are exact but for rounding.
  std::vector<Sample> corners(std::size_t axis) const {
    const MapAxis& cells = axes_[axis];
    std::vector<Sample> samples;
    for (std::size_t i = 0; i < cells.edges().size(); ++i) {
      const double edge = cells.edges()[i];
      if (axis == kLost && edge == 1.) continue;
      samples.push_back({axis == thickness() && edge == 0. ? kThin : edge, cells.around(i)});
      if (axis == thickness() && std::isinf(edge)) samples.push_back({kThick, {cells.cell(kThick)}});
    }
    return samples;
  }

  std::vector<Sample> middles(std::size_t axis) const {
    std::vector<Sample> samples;
    for (int cell = 0; cell < axes_[axis].cells(); ++cell) samples.push_back({within(axis, cell, 0.5), {cell}});
    return samples;
  }

  // Depths within each cell, evenly spread.
  std::vector<Sample> manyDepths() const {
    std::vector<Sample> samples;
    for (int cell = 0; cell < axes_[depth()].cells(); ++cell) {
      const auto [low, high] = axes_[depth()].range(cell);
      for (int i = 0; i < (low == high ? 1 : kMoreDepths); ++i)
        samples.push_back({within(depth(), cell, (i + 0.5) / kMoreDepths), {cell}});
    }
    return samples;
  }

 private:
  std::vector<MapAxis> axes_;
};

// Calls visit(chosen index on each axis) for all combinations, the last axis fastest; `skipped` stays at 0.
template <typename Visit>
void forAllOf(const std::vector<int>& counts, std::size_t skipped, const Visit& visit) {
  std::vector<int> index(counts.size(), 0);
  while (true) {
    visit(index);
    std::size_t axis = counts.size();
    while (axis-- > 0) {
      if (axis != skipped && ++index[axis] < counts[axis]) break;
      index[axis] = 0;
      if (axis == 0) return;
    }
  }
}

class Cells {
 public:
  explicit Cells(MapKind kind) : kind_(kind), axes_(kind) {
    std::size_t cells = 1;
    for (const MapAxis& axis : axes_.all()) cells *= static_cast<std::size_t>(axis.cells());
    largest_.assign(cells * spp::SlabErrorMap::columns(), 0.);
    addSamples(0, &Axes::corners);
    addSamples(1, &Axes::middles);
    addRandom();
  }

  std::size_t slabs() const { return slabs_.size(); }

  void measure(std::size_t index) {
    const Slab& slab = slabs_[index];
    Point values;
    for (const Sample& sample : slab.samples) values.push_back(sample.value);
    const bool bottomless = std::isinf(values[axes_.thickness()]);
    values[axes_.depth()] = 0.;
    const spp::MappedPlace place = spp::placeAt(kind_, values);
    std::vector<const Sample*> samples;
    std::vector<double> depths;
    for (const Sample& sample : depths_[slab.depths]) {
      if (bottomless && sample.value > 0.5) continue;
      samples.push_back(&sample);
      depths.push_back(spp::depthAt(bottomless ? std::min(sample.value, kDeep) : sample.value, place.thickness));
    }
    TierErrorSettings settings = settingsFor(place.medium);
    if (slab.depths == kManyDepths) settings.cosines = 0;
    const std::vector<TierErrors> errors = slabTierErrors(place, depths, settings);
    std::vector<Sample> touched = slab.samples;
    const std::scoped_lock lock(adding_);
    for (std::size_t d = 0; d < samples.size(); ++d) {
      touched[axes_.depth()] = *samples[d];
      std::vector<int> counts;
      for (const Sample& sample : touched) counts.push_back(static_cast<int>(sample.cells.size()));
      forAllOf(counts, counts.size(), [&](const std::vector<int>& which) {
        add(touched, which, {&errors[d * tiers_.size()], tiers_.size()});
      });
    }
  }

  spp::SlabErrorMap map() const {
    std::vector<std::uint8_t> codes;
    for (const double error : largest_) codes.push_back(spp::SlabErrorMap::code(error));
    if (settingsFor(spp::placeAt(kind_, Point(axes_.size(), 0.)).medium).cosines == 0) promiseNoRadiance(codes);
    return {axes_.all(), std::move(codes)};
  }

 private:
  static constexpr std::size_t kManyDepths = 2;  // with these, powers alone
  struct Slab {
    std::vector<Sample> samples;  // on each axis but that of depth
    std::size_t depths;           // of depths_
  };

  void addSamples(std::size_t depths, std::vector<Sample> (Axes::*make)(std::size_t) const) {
    std::vector<std::vector<Sample>> samples;
    std::vector<int> counts;
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
      samples.push_back((axes_.*make)(axis));
      counts.push_back(static_cast<int>(samples.back().size()));
    }
    depths_[depths] = samples[axes_.depth()];
    forAllOf(counts, axes_.depth(), [&](const std::vector<int>& index) {
      Slab slab{{}, depths};
      for (std::size_t axis = 0; axis < axes_.size(); ++axis)
        slab.samples.push_back(samples[axis][static_cast<std::size_t>(index[axis])]);
      slabs_.push_back(std::move(slab));
    });
  }

  // Powers at random places within each cell.
  void addRandom() {
    depths_[kManyDepths] = axes_.manyDepths();
    std::vector<int> counts;
    for (const MapAxis& axis : axes_.all()) counts.push_back(axis.cells());
    Random random(1, 0);
    forAllOf(counts, axes_.depth(), [&](const std::vector<int>& cell) {
      for (int i = 0; i < morePlaces(kind_); ++i) {
        Slab slab{{}, kManyDepths};
        for (std::size_t axis = 0; axis < axes_.size(); ++axis)
          slab.samples.push_back(
              {axis == axes_.depth() ? 0. : axes_.within(axis, cell[axis], random.uniformDouble()), {cell[axis]}});
        slabs_.push_back(std::move(slab));
      }
    });
  }

  void add(const std::vector<Sample>& samples, const std::vector<int>& which, std::span<const TierErrors> errors) {
    std::size_t cell = 0;
    for (std::size_t i = 0; i < axes_.size(); ++i)
      cell = cell * static_cast<std::size_t>(axes_.all()[i].cells()) +
             static_cast<std::size_t>(samples[i].cells[static_cast<std::size_t>(which[i])]);
    for (std::size_t t = 0; t < tiers_.size(); ++t)
      for (std::size_t q = 0; q < spp::kSlabQuantities; ++q) {
        double& largest = largest_[cell * spp::SlabErrorMap::columns() +
                                   spp::SlabErrorMap::column(tiers_[t], static_cast<spp::SlabQuantity>(q))];
        const bool radiance = static_cast<spp::SlabQuantity>(q) == spp::SlabQuantity::kRadiance;
        largest = std::max(largest, (radiance ? kRadianceMargin : kPowerMargin) * errors[t][q]);
      }
  }

  void promiseNoRadiance(std::vector<std::uint8_t>& codes) const {
    for (std::size_t cell = 0; cell < codes.size(); cell += spp::SlabErrorMap::columns())
      for (const spp::SlabTier& tier : tiers_)
        codes[cell + spp::SlabErrorMap::column(tier, spp::SlabQuantity::kRadiance)] = spp::SlabErrorMap::kNoPromise;
  }

  MapKind kind_;
  Axes axes_;
  std::span<const spp::SlabTier> tiers_ = spp::slabTiers();
  std::array<std::vector<Sample>, 3> depths_;  // corners, middles, many
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

spp::SlabErrorMap measuredErrors(MapKind kind, const Progress& progress) {
  Cells cells(kind);
  forAll(cells.slabs(), progress, [&](std::size_t i) { cells.measure(i); });
  return cells.map();
}

std::vector<CheckedPlace> checkedPlaces(MapKind kind, int count, unsigned seed, const Progress& progress) {
  const Axes axes(kind);
  std::vector<CheckedPlace> places(static_cast<std::size_t>(count));
  forAll(places.size(), progress, [&](std::size_t i) {
    Random random(seed, i);
    Point values;
    for (std::size_t a = 0; a < axes.size(); ++a) {
      const int cells = axes.all()[a].cells(),
                cell = std::min(static_cast<int>(random.uniformDouble() * cells), cells - 1);
      values.push_back(axes.within(a, cell, random.uniformDouble()));
    }
    if (std::isinf(values[axes.thickness()])) values[axes.depth()] *= kDeep;
    const spp::MappedPlace place = spp::placeAt(kind, values);
    TierErrorSettings finer{.streams = 64, .cosines = 16, .azimuths = 20};
    if (settingsFor(place.medium).cosines == 0) finer.cosines = 0;
    places[i] = {place, slabTierErrors(place, std::array{place.depth}, finer)};
  });
  return places;
}

}  // namespace sunfleck
