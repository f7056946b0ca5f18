#include "render/reference/slab_trace.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <numbers>

#include "core/random.hpp"
#include "core/require.hpp"
#include "render/reference/detail/absorption.hpp"
#include "render/reference/detail/batch_mean.hpp"
#include "render/reference/detail/ordered_batches.hpp"
#include "render/reference/detail/stopwatch.hpp"

namespace sunfleck {
using namespace detail;
namespace {

constexpr double kPi = std::numbers::pi;

// Unit vector of travel; z points down.
glm::dvec3 travel(double mu, double azimuth) {
  const double sine = std::sqrt((1. - mu) * (1. + mu));
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), mu};
}

// Probability of scattering by an angle of this cosine [1/sr].
double phase(double g, double cosine) {
  const double base = (1. - g) * (1. - g) + 2. * g * (1. - cosine);
  return (1. - g * g) / (4. * kPi * base * std::sqrt(base));
}

// The distribution function of Henyey and Greenstein inverted, with t = 2 u - 1 in -1 .. 1 and no division by g.
double sampledCosine(double g, double t) {
  const double base = 1. + g * t;
  const double cosine = (2. * t + g * (3. + t * t + g * (2. * t + g * (t * t - 1.)))) / (2. * base * base);
  return std::clamp(cosine, -1., 1.);
}

// `direction` turned by an angle of this cosine, about itself by `turn`. The axes are those of Duff et al. 2017.
glm::dvec3 turned(const glm::dvec3& direction, double cosine, double turn) {
  const double side = std::copysign(1., direction.z), a = -1. / (side + direction.z), b = direction.x * direction.y * a;
  const glm::dvec3 right(1. + side * direction.x * direction.x * a, side * b, -side * direction.x);
  const glm::dvec3 up(b, side + direction.y * direction.y * a, -direction.y);
  const double sine = std::sqrt((1. - cosine) * (1. + cosine));
  return glm::normalize(sine * std::cos(turn) * right + sine * std::sin(turn) * up + cosine * direction);
}

// Sums of the paths of one batch, a path weighing 1 when it arrives. Direct light is left out.
struct Tally {
  double reflected = 0., transmitted = 0., absorbed = 0.;
  std::vector<double> down, up;  // through each depth
  std::vector<double> radiance;  // of each view [1/sr]
};

class SlabTracer {
 public:
  SlabTracer(const TracedSlab& slab, const SlabMeasures& measures, std::uint64_t seed, std::size_t batch)
      : slab_(slab), measures_(measures), random_(seed, batch) {
    tally_.down.assign(measures.depths.size(), 0.);
    tally_.up = tally_.down;
    tally_.radiance.assign(measures.views.size(), 0.);
    for (const SlabView& view : measures.views) views_.push_back(travel(view.mu, view.azimuth));
  }

  Tally trace(std::uint64_t paths, const Stopped& stopped) {
    for (std::uint64_t i = 0; i < paths && !stopped.load(std::memory_order_relaxed); ++i) tracePath();
    return std::move(tally_);
  }

 private:
  // The light that meets nothing is known; a path carries the rest, and its first collision lies within the slab.
  void tracePath() {
    double weight = -std::expm1(-slab_.thickness / slab_.mu0);
    double depth = std::min(-slab_.mu0 * std::log1p(-random_.uniformDouble() * weight), slab_.thickness);
    glm::dvec3 direction = travel(slab_.mu0, 0.);
    for (int scatterings = 0;; ++scatterings) {
      addRadiance(depth, direction, weight * slab_.albedo);
      if (scatterings == kMostScatterings) {
        tally_.absorbed += weight;
        return;
      }
      if (!scatters(slab_.albedo, weight, tally_.absorbed, random_)) return;
      const double cosine = sampledCosine(slab_.asymmetry, 2. * random_.uniformDouble() - 1.);
      direction = turned(direction, cosine, 2. * kPi * random_.uniformDouble());
      const double next = depth - direction.z * std::log1p(-random_.uniformDouble());
      addCrossings(depth, next, weight);
      if (next <= 0. || next >= slab_.thickness) {
        (next <= 0. ? tally_.reflected : tally_.transmitted) += weight;
        return;
      }
      depth = next;
    }
  }

  // What a collision sends straight to each view: its expectation, without tracing it.
  void addRadiance(double depth, const glm::dvec3& direction, double scattered) {
    for (std::size_t i = 0; i < views_.size(); ++i) {
      const SlabView& view = measures_.views[i];
      const double way = (view.depth - depth) / view.mu;
      if (way < 0.) continue;
      const double towards = phase(slab_.asymmetry, glm::dot(direction, views_[i]));
      tally_.radiance[i] += scattered * towards * std::exp(-way) / std::abs(view.mu);
    }
  }

  void addCrossings(double from, double to, double weight) {
    for (std::size_t i = 0; i < measures_.depths.size(); ++i) {
      const double depth = measures_.depths[i];
      if (from < depth && depth <= to) tally_.down[i] += weight;
      if (to <= depth && depth < from) tally_.up[i] += weight;
    }
  }

  const TracedSlab& slab_;
  const SlabMeasures& measures_;
  std::vector<glm::dvec3> views_;
  Random random_;
  Tally tally_;
};

// The means over the batches, and the result they make.
class SlabMeans {
 public:
  explicit SlabMeans(const SlabMeasures& measures)
      : down_(measures.depths.size()), up_(measures.depths.size()), radiance_(measures.views.size()) {}

  void add(const Tally& tally, double paths) {
    count_ += 1.;
    const auto addAll = [&](std::vector<BatchMean>& means, const std::vector<double>& sums) {
      for (std::size_t i = 0; i < means.size(); ++i) means[i].add(sums[i] / paths, count_);
    };
    reflected_.add(tally.reflected / paths, count_);
    transmitted_.add(tally.transmitted / paths, count_);
    absorbed_.add(tally.absorbed / paths, count_);
    addAll(down_, tally.down);
    addAll(up_, tally.up);
    addAll(radiance_, tally.radiance);
  }

  SlabTraceResult result(const TracedSlab& slab, const SlabMeasures& measures) const {
    const auto scaled = [&](const BatchMean& mean, double scale, double known) {
      const Estimate estimate = mean.estimate(count_);
      return Estimate{scale * estimate.value + known, scale * estimate.standard_error};
    };
    SlabTraceResult result;
    result.direct = std::exp(-slab.thickness / slab.mu0);
    result.reflectance = scaled(reflected_, 1., 0.);
    result.transmittance = scaled(transmitted_, 1., result.direct);
    result.absorptance = scaled(absorbed_, 1., 0.);
    for (std::size_t i = 0; i < down_.size(); ++i) {
      const double direct = slab.mu0 * std::exp(-measures.depths[i] / slab.mu0);
      result.flux_down.push_back(scaled(down_[i], slab.mu0, direct));
      result.flux_up.push_back(scaled(up_[i], slab.mu0, 0.));
    }
    for (const BatchMean& mean : radiance_) result.radiance.push_back(scaled(mean, slab.mu0, 0.));
    return result;
  }

 private:
  double count_ = 0.;
  BatchMean reflected_, transmitted_, absorbed_;
  std::vector<BatchMean> down_, up_, radiance_;
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
  const Stopwatch stopwatch;
  const auto parts = [&](std::uint64_t size) { return (effort.paths + size - 1) / size; };
  const std::uint64_t batches = std::max<std::uint64_t>(kTraceBatches, parts(kMostBatchPaths));
  const std::uint64_t per_batch = parts(batches);
  SlabMeans means(measures);
  std::uint64_t paths = 0;
  inOrder(
      batches, effort.threads,
      [&](std::size_t batch, const Stopped& stopped) {
        return SlabTracer(slab, measures, effort.seed, batch).trace(per_batch, stopped);
      },
      [&](std::size_t batch, const Tally& tally) {
        means.add(tally, static_cast<double>(per_batch));
        paths += per_batch;
        return goOn(progress, static_cast<double>(batch + 1) / static_cast<double>(batches));
      });
  SlabTraceResult result = means.result(slab, measures);
  result.paths = paths;
  result.seconds = stopwatch.seconds();
  result.cpu_seconds = stopwatch.cpuSeconds();
  return result;
}

}  // namespace sunfleck
