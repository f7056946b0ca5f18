#include "render/reference/forward_trace.hpp"

#include <algorithm>
#include <cmath>

#include "core/random.hpp"
#include "core/require.hpp"
#include "render/reference/detail/absorption.hpp"
#include "render/reference/detail/batch_mean.hpp"
#include "render/reference/detail/cosine_law.hpp"
#include "render/reference/detail/ordered_batches.hpp"
#include "render/reference/detail/scene_geometry.hpp"
#include "render/reference/detail/stopwatch.hpp"
#include "render/reference/detail/sunlit_faces.hpp"

namespace sunfleck {
using namespace detail;
namespace {

// Sums of the paths of one batch, a path weighing 1 when it starts.
struct Tally {
  double reflected = 0., absorbed_leaves = 0., absorbed_wood = 0.;
  double arriving_ground = 0., arriving_ground_direct = 0., absorbed_ground = 0.;
  std::vector<double> leaf;  // arriving at each
};

class BatchTracer {
 public:
  BatchTracer(const RayScene::Geometry& scene, const TraceLight& light, const SunlitFaces& faces, std::uint64_t seed,
              std::size_t batch)
      : scene_(scene), light_(light), faces_(faces), random_(seed, batch) {
    tally_.leaf.assign(scene.leaf_area.size(), 0.);
  }

  Tally trace(std::uint64_t paths, const Stopped& stopped) {
    EvenPoints points(random_);
    for (std::uint64_t i = 0; i < paths && !stopped.load(std::memory_order_relaxed); ++i, points.next())
      tracePath(faces_.start(points.u(), points.v()));
    return std::move(tally_);
  }

 private:
  void tracePath(glm::vec3 from) {
    glm::vec3 direction = light_.sun;
    double weight = 1.;
    for (int scatterings = 0;; ++scatterings) {
      const Hit hit = scene_.closest(from, direction, Coherence::incoherent);
      if (hit.surface == Surface::none && direction.z >= 0.f) {
        tally_.reflected += weight;
        return;
      }
      if (hit.surface == Surface::none && scatterings == 0) tally_.arriving_ground_direct += weight;
      double& absorbed = arrive(hit, weight);
      if (scatterings == kMostScatterings) {
        absorbed += weight;
        return;
      }
      if (!scatters(albedo(hit), weight, absorbed, random_)) return;
      leave(hit, from, direction);
    }
  }

  // Counts the arrival at what was hit, nothing being the ground, and names where its absorbed light is kept.
  double& arrive(const Hit& hit, double weight) {
    if (hit.surface == Surface::wood) return tally_.absorbed_wood;
    if (hit.surface == Surface::leaf) {
      tally_.leaf[hit.leaf] += weight;
      return tally_.absorbed_leaves;
    }
    tally_.arriving_ground += weight;
    return tally_.absorbed_ground;
  }

  double albedo(const Hit& hit) const {
    if (hit.surface == Surface::none) return double{light_.ground_albedo};
    const TreeOptics tree = light_.ofKind(hit.kind);
    return hit.surface == Surface::wood ? double{tree.wood_reflectance} : double{tree.leaf.albedo()};
  }

  void leave(const Hit& hit, glm::vec3& from, glm::vec3& direction) {
    if (hit.surface == Surface::none) {
      from = scene_.wrapped(from + (scene_.low - from.z) / direction.z * direction);
      from.z = scene_.low;
      direction = lambertDirection({0.f, 0.f, 1.f}, random_);
      return;
    }
    const LeafOptics optics = light_.ofKind(hit.kind).leaf;
    const bool passes = hit.surface == Surface::leaf && random_.uniform() * optics.albedo() >= optics.reflectance;
    const glm::vec3 side = passes ? -hit.normal : hit.normal;
    from = scene_.leave(hit.position, side);
    direction = lambertDirection(side, random_);
  }

  const RayScene::Geometry& scene_;
  const TraceLight& light_;
  const SunlitFaces& faces_;
  Random random_;
  Tally tally_;
};

// The means over the batches, and the result they make.
class ForwardMeans {
 public:
  // `flux_per_area`: what a share of the incident flux means as irradiance of each leaf [1].
  explicit ForwardMeans(std::vector<double> flux_per_area)
      : flux_per_area_(std::move(flux_per_area)), leaf_(flux_per_area_.size()) {}

  void add(const Tally& tally, double paths) {
    count_ += 1.;
    reflected_.add(tally.reflected / paths, count_);
    absorbed_leaves_.add(tally.absorbed_leaves / paths, count_);
    absorbed_wood_.add(tally.absorbed_wood / paths, count_);
    arriving_ground_.add(tally.arriving_ground / paths, count_);
    arriving_ground_direct_.add(tally.arriving_ground_direct / paths, count_);
    absorbed_ground_.add(tally.absorbed_ground / paths, count_);
    for (std::size_t i = 0; i < leaf_.size(); ++i) leaf_[i].add(tally.leaf[i] / paths * flux_per_area_[i], count_);
  }

  ForwardResult result() const {
    ForwardResult result{.reflected = reflected_.estimate(count_),
                         .absorbed_leaves = absorbed_leaves_.estimate(count_),
                         .absorbed_wood = absorbed_wood_.estimate(count_),
                         .arriving_ground = arriving_ground_.estimate(count_),
                         .arriving_ground_direct = arriving_ground_direct_.estimate(count_),
                         .absorbed_ground = absorbed_ground_.estimate(count_),
                         .leaf_irradiance = {},
                         .leaf_standard_error = {}};
    for (const BatchMean& leaf : leaf_) {
      const Estimate irradiance = leaf.estimate(count_);
      result.leaf_irradiance.push_back(irradiance.value);
      result.leaf_standard_error.push_back(irradiance.standard_error);
    }
    return result;
  }

 private:
  double count_ = 0.;
  BatchMean reflected_, absorbed_leaves_, absorbed_wood_, arriving_ground_, arriving_ground_direct_, absorbed_ground_;
  std::vector<double> flux_per_area_;
  std::vector<BatchMean> leaf_;
};

std::vector<double> fluxPerArea(const RayScene::Geometry& scene, double flux) {
  std::vector<double> result = scene.leaf_area;
  for (double& value : result) value = flux / value;
  return result;
}

}  // namespace

void validate(const TraceLight& light) {
  const double length = glm::length(glm::dvec3(light.sun));
  require(std::abs(length - 1.) < 1e-4, "length of the sun's direction", length, "1");
  require(light.sun.z < 0.f, "z of the sun's direction", light.sun.z, "below 0: sunlight travels down");
  const auto validateTree = [](const TreeOptics& tree) {
    validate(tree.leaf);
    require(tree.wood_reflectance >= 0.f && tree.wood_reflectance <= 1.f, "wood reflectance", tree.wood_reflectance,
            "in [0, 1]");
  };
  validateTree({light.leaf, light.wood_reflectance});
  for (const TreeOptics& tree : light.of_kinds) validateTree(tree);
  require(light.ground_albedo >= 0.f && light.ground_albedo <= 1.f, "ground albedo", light.ground_albedo, "in [0, 1]");
}

void validate(const TraceEffort& effort) {
  require(effort.paths >= kTraceBatches && effort.paths <= 1'000'000'000'000'000u, "number of paths", effort.paths,
          "from " + std::to_string(kTraceBatches) + " to 1e15");
  require(effort.threads >= 0 && effort.threads <= 4096, "number of threads", effort.threads,
          "from 0 (all cores) to 4096");
}

void requireFitting(const TraceLight& light, const RayScene& scene) {
  validate(light);
  const std::size_t kinds = scene.geometry().prototypes.size();
  require(light.of_kinds.empty() || light.of_kinds.size() == kinds, "number of kinds of trees with optics",
          light.of_kinds.size(), "that of the traced scene, " + std::to_string(kinds));
}

ForwardResult traceForward(const RayScene& scene, const TraceLight& light, const TraceEffort& effort,
                           const Progress& progress) {
  requireFitting(light, scene);
  validate(effort);
  const RayScene::Geometry& geometry = scene.geometry();
  require(geometry.period || light.ground_albedo == 0.f, "ground albedo", light.ground_albedo,
          "0 in a forward trace of a stand without period");

  const Stopwatch stopwatch;
  const SunlitFaces faces(geometry, light.sun);
  const auto parts = [&](std::uint64_t size) { return (effort.paths + size - 1) / size; };
  const std::uint64_t batches = std::max<std::uint64_t>(kTraceBatches, parts(kMostBatchPaths));
  const std::uint64_t per_batch = parts(batches);
  ForwardMeans means(fluxPerArea(geometry, faces.flux()));
  std::uint64_t paths = 0;
  inOrder(
      batches, effort.threads,
      [&](std::size_t batch, const Stopped& stopped) {
        return BatchTracer(geometry, light, faces, effort.seed, batch).trace(per_batch, stopped);
      },
      [&](std::size_t batch, const Tally& tally) {
        means.add(tally, static_cast<double>(per_batch));
        paths += per_batch;
        return goOn(progress, static_cast<double>(batch + 1) / static_cast<double>(batches));
      });
  ForwardResult result = means.result();
  result.paths = paths;
  result.seconds = stopwatch.seconds();
  result.cpu_seconds = stopwatch.cpuSeconds();
  return result;
}

}  // namespace sunfleck
