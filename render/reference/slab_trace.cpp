#include "render/reference/slab_trace.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <numbers>

#include "core/elapsed.hpp"
#include "core/require.hpp"
#include "render/reference/detail/absorption.hpp"
#include "render/reference/detail/henyey_greenstein.hpp"
#include "render/reference/trace_job.hpp"
#include "render/reference/trace_run.hpp"

namespace sunfleck {
using namespace detail;
namespace {

constexpr double kPi = std::numbers::pi;

// Unit vector of travel; z points down.
glm::dvec3 travel(double mu, double azimuth) {
  const double sine = std::sqrt((1. - mu) * (1. + mu));
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), mu};
}

// `direction` turned by an angle of this cosine, about itself by `turn`. The axes are those of Duff et al. 2017.
glm::dvec3 turned(const glm::dvec3& direction, double cosine, double turn) {
  const double side = std::copysign(1., direction.z), a = -1. / (side + direction.z), b = direction.x * direction.y * a;
  const glm::dvec3 right(1. + side * direction.x * direction.x * a, side * b, -side * direction.x);
  const glm::dvec3 up(b, side + direction.y * direction.y * a, -direction.y);
  const double sine = std::sqrt((1. - cosine) * (1. + cosine));
  return glm::normalize(sine * std::cos(turn) * right + sine * std::sin(turn) * up + cosine * direction);
}

// Where each number is kept among the bins. Direct light is left out of all.
struct Layout {
  std::size_t depths, views;

  static constexpr std::size_t kReflected = 0, kTransmitted = 1, kAbsorbed = 2;
  std::size_t down(std::size_t depth) const { return 3 + depth; }
  std::size_t up(std::size_t depth) const { return down(depths) + depth; }
  std::size_t radiance(std::size_t view) const { return up(depths) + view; }  // [1/sr]
  std::size_t bins() const { return radiance(views); }
};

// Traces the paths of one unit, a path weighing `share` of the incident light when it arrives.
class SlabPaths {
 public:
  SlabPaths(const TracedSlab& slab, const SlabMeasures& measures, double share, UnitTally& tally)
      : slab_(slab),
        measures_(measures),
        layout_{.depths = measures.depths.size(), .views = measures.views.size()},
        share_(share),
        tally_(tally) {
    for (const SlabView& view : measures.views) views_.push_back(travel(view.mu, view.azimuth));
  }

  // The light that meets nothing is known; a path carries the rest, and its first collision lies within the slab.
  void trace(PathRandom& random) {
    double weight = -std::expm1(-slab_.thickness / slab_.mu0);
    double depth = std::min(-slab_.mu0 * std::log1p(-random.uniformDouble() * weight), slab_.thickness);
    glm::dvec3 direction = travel(slab_.mu0, 0.);
    for (int scatterings = 0;; ++scatterings) {
      addRadiance(depth, direction, weight * slab_.albedo);
      if (scatterings == kMostScatterings) {
        count(Layout::kAbsorbed, weight);
        return;
      }
      double absorbed = 0.;
      const bool goes_on = scatters(slab_.albedo, weight, absorbed, random);
      count(Layout::kAbsorbed, absorbed);
      if (!goes_on) return;
      const double cosine = sampledCosine(slab_.asymmetry, 2. * random.uniformDouble() - 1.);
      direction = turned(direction, cosine, 2. * kPi * random.uniformDouble());
      const double next = depth - direction.z * std::log1p(-random.uniformDouble());
      addCrossings(depth, next, weight);
      if (next <= 0. || next >= slab_.thickness) {
        count(next <= 0. ? Layout::kReflected : Layout::kTransmitted, weight);
        return;
      }
      depth = next;
    }
  }

 private:
  void count(std::size_t bin, double weight) { tally_.add(bin, share_ * weight); }

  // What a collision sends straight to each view: its expectation, without tracing it.
  void addRadiance(double depth, const glm::dvec3& direction, double scattered) {
    for (std::size_t i = 0; i < views_.size(); ++i) {
      const SlabView& view = measures_.views[i];
      const double way = (view.depth - depth) / view.mu;
      if (way < 0.) continue;
      const double towards = henyeyGreenstein(slab_.asymmetry, glm::dot(direction, views_[i]));
      count(layout_.radiance(i), scattered * towards * std::exp(-way) / std::abs(view.mu));
    }
  }

  void addCrossings(double from, double to, double weight) {
    for (std::size_t i = 0; i < measures_.depths.size(); ++i) {
      const double depth = measures_.depths[i];
      if (from < depth && depth <= to) count(layout_.down(i), weight);
      if (to <= depth && depth < from) count(layout_.up(i), weight);
    }
  }

  const TracedSlab& slab_;
  const SlabMeasures& measures_;
  Layout layout_;
  double share_;
  UnitTally& tally_;
  std::vector<glm::dvec3> views_;
};

class SlabJob final : public TraceJob {
 public:
  SlabJob(const TracedSlab& slab, const SlabMeasures& measures, std::uint64_t paths_per_unit)
      : slab_(slab),
        measures_(measures),
        layout_{.depths = measures.depths.size(), .views = measures.views.size()},
        paths_per_unit_(paths_per_unit) {}

  std::size_t bins() const override { return layout_.bins(); }
  TraceIdentity identity() const override { return {}; }
  void trace(std::uint64_t seed, std::uint64_t unit, UnitTally& tally, const Stopped& stopped) const override {
    SlabPaths paths(slab_, measures_, 1. / static_cast<double>(paths_per_unit_), tally);
    for (std::uint64_t i = 0; i < paths_per_unit_ && !stopped.load(std::memory_order_relaxed); ++i) {
      PathRandom random(Stream::slab, seed, unit * paths_per_unit_ + i);
      paths.trace(random);
    }
  }

  SlabTraceResult result(const TraceSums& sums) const {
    const auto scaled = [&](std::size_t bin, double scale, double known) {
      const Estimate estimate = sums.estimate(bin);
      return Estimate{scale * estimate.value + known, scale * estimate.standard_error};
    };
    SlabTraceResult result;
    result.direct = std::exp(-slab_.thickness / slab_.mu0);
    result.reflectance = sums.estimate(Layout::kReflected);
    result.transmittance = scaled(Layout::kTransmitted, 1., result.direct);
    result.absorptance = sums.estimate(Layout::kAbsorbed);
    for (std::size_t i = 0; i < layout_.depths; ++i) {
      const double direct = slab_.mu0 * std::exp(-measures_.depths[i] / slab_.mu0);
      result.flux_down.push_back(scaled(layout_.down(i), slab_.mu0, direct));
      result.flux_up.push_back(scaled(layout_.up(i), slab_.mu0, 0.));
    }
    for (std::size_t i = 0; i < layout_.views; ++i)
      result.radiance.push_back(scaled(layout_.radiance(i), slab_.mu0, 0.));
    result.paths = sums.units() * paths_per_unit_;
    return result;
  }

 private:
  TracedSlab slab_;
  SlabMeasures measures_;
  Layout layout_;
  std::uint64_t paths_per_unit_;
};

void validate(const TracedSlab& slab, const SlabMeasures& measures) {
  require(slab.asymmetry > -1. && slab.asymmetry < 1., "asymmetry", slab.asymmetry, "in (-1, 1)");
  require(slab.albedo >= 0. && slab.albedo <= 1., "albedo", slab.albedo, "in [0, 1]");
  require(slab.thickness > 0., "thickness", slab.thickness, "above 0");
  require(slab.mu0 > 0. && slab.mu0 <= 1., "mu0", slab.mu0, "in (0, 1]");
  const auto requireDepth = [&](double depth) {
    require(depth >= 0. && depth <= slab.thickness && std::isfinite(depth), "depth", depth,
            "finite and from 0 to the thickness");
  };
  for (const double depth : measures.depths) requireDepth(depth);
  for (const SlabView& view : measures.views) {
    requireDepth(view.depth);
    require(std::abs(view.mu) <= 1. && view.mu != 0., "mu", view.mu, "in [-1, 1] and not 0");
    require(std::isfinite(view.azimuth), "phi", view.azimuth, "finite");
  }
}

}  // namespace

SlabTraceResult traceSlab(const TracedSlab& slab, const SlabMeasures& measures, const TraceEffort& effort,
                          const Progress& progress) {
  validate(slab, measures);
  validate(effort);
  const Elapsed elapsed;
  const std::uint64_t per_unit = pathsPerUnit(effort.paths);
  const SlabJob job(slab, measures, per_unit);
  TraceSums sums(job.bins(), job.groups());
  runUnits(job, {.seed = effort.seed, .wanted = {0, unitsOf(effort.paths, per_unit)}, .threads = effort.threads}, sums,
           progress);
  SlabTraceResult result = job.result(sums);
  result.seconds = elapsed.seconds();
  result.cpu_seconds = elapsed.cpuSeconds();
  return result;
}

}  // namespace sunfleck
