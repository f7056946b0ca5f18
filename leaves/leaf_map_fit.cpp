#include "leaves/leaf_map_fit.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "core/require.hpp"
#include "leaves/leaf_textures.hpp"
#include "leaves/slab_leaf.hpp"
#include "leaves/tissue_by_thickness.hpp"

namespace sunfleck {
namespace {

constexpr double kThickest = 4.;  // times h
constexpr int kMostRounds = 40, kSearchRows = 64, kRefinements = 4;
constexpr double kMostExtinction = 1e6;  // of TissueByThickness [1/mm]
constexpr double kNearEnough = 1e-6;
constexpr double kLeastShare = 1e-4;  // of tissueOf()
constexpr std::size_t kGrain = 2048, kPartsBetweenAsking = 64;

using Bands = std::array<double, kBands>;

// What is summed over the places on the leaf.
struct Sums {
  double thickness = 0.;
  Bands gamma{}, transmittance{}, squares{};
  void add(const Sums& other) {
    thickness += other.thickness;
    for (std::size_t band = 0; band < kBands; ++band) {
      gamma[band] += other.gamma[band];
      transmittance[band] += other.transmittance[band];
      squares[band] += other.squares[band];
    }
  }
};

double gammaOf(double measured, double even) {
  return std::clamp(measured / std::max(even, 1e-9), 0., double{kMostLeafAlbedo});
}

// Thickness of the least sum of squares: the nearest of a few, then Gauss and Newton's steps between its neighbours.
class ThicknessSearch {
 public:
  ThicknessSearch(const TissueByThickness& tissue, double thickest) : tissue_(tissue), thickest_(thickest) {
    for (int i = 0; i <= kSearchRows; ++i) {
      // Closer where leaves are thin.
      const double x = static_cast<double>(i) / kSearchRows;
      thickness_[static_cast<std::size_t>(i)] = thickest * x * x;
      rows_[static_cast<std::size_t>(i)] = tissue.at(thickness_[static_cast<std::size_t>(i)]).transmittance;
    }
  }

  double nearestTo(const glm::vec3& measured) const {
    const auto squares = [&](const Bands& t) {
      double sum = 0.;
      for (int band = 0; band < kBands; ++band) {
        const double off = t[static_cast<std::size_t>(band)] - double{measured[band]};
        sum += off * off;
      }
      return sum;
    };
    std::size_t best = 0;
    double least = squares(rows_[0]);
    for (std::size_t i = 1; i < rows_.size(); ++i)
      if (const double sum = squares(rows_[i]); sum < least) {
        least = sum;
        best = i;
      }
    const double low = best > 0 ? thickness_[best - 1] : 0.;
    const double high = best + 1 < thickness_.size() ? thickness_[best + 1] : thickest_;
    double at = thickness_[best];
    const double apart = 1e-3 * (high - low);
    for (int i = 0; i < kRefinements; ++i) {
      const double from = std::max(at - apart, 0.), to = std::min(at + apart, thickest_);
      const Bands less = tissue_.at(from).transmittance, more = tissue_.at(to).transmittance;
      double slope_off = 0., slopes = 0.;
      for (int band = 0; band < kBands; ++band) {
        const auto b = static_cast<std::size_t>(band);
        const double slope = (more[b] - less[b]) / (to - from);
        const double value = less[b] + slope * (at - from);
        slope_off += slope * (value - double{measured[band]});
        slopes += slope * slope;
      }
      if (!(slopes > 0.)) break;
      at = std::clamp(at - slope_off / slopes, low, high);
    }
    return at;
  }

 private:
  const TissueByThickness& tissue_;
  double thickest_;
  std::array<double, kSearchRows + 1> thickness_{};
  std::array<Bands, kSearchRows + 1> rows_{};
};

void requireMaps(const MeasuredLeafMaps& measured) {
  const std::size_t places = measured.reflectance.size();
  require(measured.transmittance.size() == places, "number of transmittances", measured.transmittance.size(),
          "that of reflectances");
  require(measured.lower_reflectance.empty() || measured.lower_reflectance.size() == places,
          "number of lower reflectances", measured.lower_reflectance.size(), "that of reflectances");
  require(measured.on_leaf.empty() || measured.on_leaf.size() == places, "number of marks of the leaf",
          measured.on_leaf.size(), "that of reflectances");
  const auto requireShares = [](const std::vector<glm::vec3>& all, const char* what) {
    for (const glm::vec3& shares : all)
      for (int band = 0; band < kBands; ++band)
        require(shares[band] >= 0.f && shares[band] <= 1.f, what, shares[band], "in [0, 1]");
  };
  requireShares(measured.reflectance, "reflectance");
  requireShares(measured.transmittance, "transmittance");
  requireShares(measured.lower_reflectance, "lower reflectance");
}

// On its way to the tissue of a leaf.
class MapFit {
 public:
  MapFit(const MeasuredLeafMaps& measured, double thickness, const Progress& progress)
      : measured_(measured), mean_thickness_(thickness), progress_(progress) {
    for (std::size_t i = 0; i < measured.reflectance.size(); ++i)
      if (measured.on_leaf.empty() || measured.on_leaf[i]) places_.push_back(i);
    require(!places_.empty(), "number of places on the leaf", places_.size(), "at least 1");
    Bands reflectance{};
    for (const std::size_t place : places_)
      for (int band = 0; band < kBands; ++band) {
        reflectance[static_cast<std::size_t>(band)] += double{measured.reflectance[place][band]};
        mean_[static_cast<std::size_t>(band)] += double{measured.transmittance[place][band]};
      }
    constexpr std::array kNames{"red", "green", "blue"};
    for (std::size_t band = 0; band < kBands; ++band) {
      mean_[band] /= static_cast<double>(places_.size());
      reflectance[band] /= static_cast<double>(places_.size());
      for (const auto& [share, what] :
           {std::pair(reflectance[band], "mean reflectance in "), {mean_[band], "mean transmittance in "}})
        require(share >= kLeastShare, std::string(what) + kNames[band], share, "at least 1e-4");
      target_[band] = {.reflectance = reflectance[band], .transmittance = mean_[band]};
    }
    thickness_.resize(places_.size());
  }

  LeafMapFit run() {
    LeafMapFit fit;
    while (fit.rounds < kMostRounds && !fit.converged) {
      done_ = static_cast<double>(fit.rounds++) / (kMostRounds + 1);
      fit.converged = step();
    }
    finish(fit);
    return fit;
  }

 private:
  // Tissue from the targets; thickness from the tissue; targets from where means are off. Whether none was.
  bool step() {
    for (LeafSides& sides : target_) {
      sides.transmittance = std::clamp(sides.transmittance, kLeastShare, 1. - kLeastShare);
      sides.reflectance = std::clamp(sides.reflectance, 0., 1. - sides.transmittance);
    }
    const std::vector<TissueFit> fits = tissueOf(target_, mean_thickness_);
    for (int band = 0; band < kBands; ++band) {
      const LeafTissue& tissue = fits[static_cast<std::size_t>(band)].tissue;
      absorption_[band] = std::min(tissue.absorption, kMostExtinction);
      scattering_[band] = std::min(tissue.scattering, kMostExtinction);
    }
    const TissueByThickness tissue(absorption_, scattering_, 0., kThickest * mean_thickness_);
    const Sums sums = search(tissue);
    // Tissue times this with places thinner by this is the same leaf: so delta becomes 0 in the mean.
    const auto count = static_cast<double>(places_.size());
    const double mean = sums.thickness / count, wider = mean / mean_thickness_;
    absorption_ = glm::min(absorption_ * wider, kMostExtinction);
    scattering_ = glm::min(scattering_ * wider, kMostExtinction);
    bool near = std::abs(wider - 1.) < kNearEnough;
    const TissueBands before = tissue.at(mean_thickness_), even = tissue.at(mean);
    const Bands off = withoutThickness(meansOff(sums), tissue, mean);
    for (std::size_t band = 0; band < kBands; ++band) {
      const double gamma = sums.gamma[band] / count;
      near = near && std::abs(gamma - 1.) < kNearEnough && std::abs(off[band]) < kNearEnough;
      // By differences: tissueOf() and the table have not the same directions.
      target_[band].reflectance += even.reflectance[band] * gamma - before.reflectance[band];
      target_[band].transmittance += even.transmittance[band] - off[band] - before.transmittance[band];
    }
    return near;
  }

  Bands meansOff(const Sums& sums) const {
    Bands off;
    for (std::size_t band = 0; band < kBands; ++band)
      off[band] = sums.transmittance[band] / static_cast<double>(places_.size()) - mean_[band];
    return off;
  }

  // What no change of all thicknesses would explain: that part is delta's, by least squares, and noise keeps a little
  // of it.
  static Bands withoutThickness(Bands off, const TissueByThickness& tissue, double mean) {
    const double apart = 1e-2 * mean;
    const Bands thinner = tissue.at(mean - apart).transmittance, thicker = tissue.at(mean + apart).transmittance;
    double along = 0., slopes = 0.;
    for (std::size_t band = 0; band < kBands; ++band) {
      const double slope = thicker[band] - thinner[band];
      along += slope * off[band];
      slopes += slope * slope;
    }
    for (std::size_t band = 0; band < kBands && slopes > 0.; ++band)
      off[band] -= (thicker[band] - thinner[band]) * along / slopes;
    return off;
  }

  Sums search(const TissueByThickness& tissue) {
    const ThicknessSearch search(tissue, kThickest * mean_thickness_);
    std::vector<Sums> parts((places_.size() + kGrain - 1) / kGrain);
    const auto searchPart = [&](std::size_t part) {
      for (std::size_t i = part * kGrain; i < std::min((part + 1) * kGrain, places_.size()); ++i) {
        const glm::vec3& measured = measured_.transmittance[places_[i]];
        thickness_[i] = search.nearestTo(measured);
        const TissueBands even = tissue.at(thickness_[i]);
        parts[part].thickness += thickness_[i];
        for (int band = 0; band < kBands; ++band) {
          const auto b = static_cast<std::size_t>(band);
          parts[part].gamma[b] += gammaOf(double{measured_.reflectance[places_[i]][band]}, even.reflectance[b]);
          parts[part].transmittance[b] += even.transmittance[b];
          parts[part].squares[b] += std::pow(even.transmittance[b] - double{measured[band]}, 2);
        }
      }
    };
    for (std::size_t first = 0; first < parts.size(); first += kPartsBetweenAsking) {
      requireGoOn(progress_, done_);
      tbb::parallel_for(first, std::min(first + kPartsBetweenAsking, parts.size()), searchPart);
    }
    Sums all;  // in order: the same for any number of threads
    for (const Sums& part : parts) all.add(part);
    return all;
  }

  void finish(LeafMapFit& fit) {
    fit.tissue = {
        .absorption = glm::vec3(absorption_), .scattering = glm::vec3(scattering_), .thickness = mean_thickness_};
    const double thickest = kThickest * mean_thickness_;
    const TissueByThickness tissue(glm::dvec3(fit.tissue.absorption), glm::dvec3(fit.tissue.scattering), 0., thickest);
    const Sums sums = search(tissue);
    const std::size_t all = measured_.reflectance.size();
    fit.places = places_.size();
    fit.gamma.assign(all, glm::vec3(1.f));
    if (!measured_.lower_reflectance.empty()) fit.lower_gamma = fit.gamma;
    fit.delta.assign(all, 0.f);
    for (int band = 0; band < kBands; ++band)
      fit.rms_transmittance[band] =
          std::sqrt(sums.squares[static_cast<std::size_t>(band)] / static_cast<double>(places_.size()));
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const std::size_t place = places_[i];
      const TissueBands even = tissue.at(thickness_[i]);
      fit.delta[place] = static_cast<float>(thickness_[i] - mean_thickness_);
      bool capped = false;
      for (int band = 0; band < kBands; ++band) {
        const auto b = static_cast<std::size_t>(band);
        const auto of = [&](const std::vector<glm::vec3>& measured) {
          const auto reflectance = double{measured[place][band]};
          capped = capped || reflectance + even.transmittance[b] > 1.;
          return static_cast<float>(gammaOf(reflectance, even.reflectance[b]));
        };
        fit.gamma[place][band] = of(measured_.reflectance);
        if (!fit.lower_gamma.empty()) fit.lower_gamma[place][band] = of(measured_.lower_reflectance);
      }
      fit.capped += capped ? 1 : 0;
      fit.at_limit += thickness_[i] <= 0. || thickness_[i] >= thickest ? 1 : 0;
    }
  }

  const MeasuredLeafMaps& measured_;
  double mean_thickness_;  // h [mm]
  const Progress& progress_;
  double done_ = 0.;
  std::vector<std::size_t> places_;       // on the leaf
  std::vector<double> thickness_;         // of each of them [mm]
  Bands mean_{};                          // transmittance as measured
  std::array<LeafSides, kBands> target_;  // of the slab of thickness h
  glm::dvec3 absorption_{0.}, scattering_{0.};
};

}  // namespace

LeafMapFit fitLeafMaps(const MeasuredLeafMaps& measured, double thickness, const Progress& progress) {
  require(thickness >= 0.001 && thickness <= 250., "thickness", thickness, "in [0.001, 250] mm");
  requireMaps(measured);
  return MapFit(measured, thickness, progress).run();
}

}  // namespace sunfleck
