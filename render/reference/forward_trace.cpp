#include "render/reference/forward_trace.hpp"

#include <algorithm>
#include <cmath>

#include "core/elapsed.hpp"
#include "core/require.hpp"
#include "render/reference/detail/identity_text.hpp"
#include "render/reference/detail/scattering.hpp"
#include "render/reference/detail/scene_geometry.hpp"
#include "render/reference/detail/scene_optics.hpp"
#include "render/reference/detail/sunlit_faces.hpp"
#include "render/reference/trace_run.hpp"

namespace sunfleck {
using namespace detail;
namespace {

// Where each number is kept among the bins of a run of B bands.
struct Layout {
  std::size_t bands, leaves;

  enum Total { reflected, absorbed_leaves, absorbed_wood, absorbed_ground, absorbed_particles, arriving_ground };
  static constexpr std::size_t kTotals = 6;
  std::size_t total(Total which, int band) const { return which * bands + index(band); }
  // Direct light is the same in all bands.
  std::size_t direct() const { return kTotals * bands; }

  enum Leaving { upward, downward };
  std::size_t orders(Leaving how) const { return direct() + 1 + how * OrderTable::kBins * bands; }
  std::size_t order(Leaving how, std::size_t bin, int band) const { return orders(how) + bin * bands + index(band); }

  // Of each leaf, front and back: all light of each band, and the direct.
  std::size_t leafSide(std::size_t leaf, bool front) const {
    return direct() + 1 + 2 * OrderTable::kBins * bands + (2 * leaf + (front ? 0 : 1)) * (bands + 1);
  }
  std::size_t bins() const { return leafSide(leaves, true); }

 private:
  static std::size_t index(int band) { return static_cast<std::size_t>(band); }
};

template <int N>
class ForwardPaths {
 public:
  ForwardPaths(const RayScene::Geometry& scene, const SunlitFaces& faces, Direction sun, const SceneOptics<N>& optics,
               const Layout& layout, double share, UnitTally& tally)
      : scene_(scene), faces_(faces), sun_(sun), optics_(optics), layout_(layout), share_(share), tally_(tally) {}

  void trace(PathRandom& random) {
    const Pair start = random.pair();
    glm::vec3 from = faces_.start(double{start.u}, double{start.v});
    glm::vec3 direction = sun_;
    BandLanes<N> weight = BandLanes<N>::all(1.f);
    int reflections = 0, passes = 0;
    for (int scatterings = 0;; ++scatterings) {
      Hit hit = scene_.meet(from, direction, random);
      const bool none = hit.surface == Surface::none;
      if (none) leave(direction.z >= 0.f ? Layout::upward : Layout::downward, weight, reflections, passes);
      if (none && direction.z >= 0.f) return;
      if (none) meetGround(hit, from, direction);
      if (scatterings == 0) arriveDirect(hit);
      if (hit.surface == Surface::leaf) addTo(layout_.leafSide(hit.leaf, hit.front), weight);
      const BandLanes<N> arriving = weight;
      Onward onward = optics_.scatter(hit, weight, random);
      if (scatterings == kMostScatterings) onward.fate = Fate::absorbed;
      const Fate fate = onward.fate;
      if (fate == Fate::absorbed) weight = {};
      keep(layout_.total(absorbedBy(hit.surface), 0), arriving, weight);
      if (fate == Fate::absorbed) return;
      if (isLeaf(hit.surface)) ++(fate == Fate::passed ? passes : reflections);
      from = scene_.leave(hit.position, onward.side);
      direction = onward.direction;
    }
  }

 private:
  static bool isLeaf(Surface surface) { return surface == Surface::leaf || surface == Surface::turbid_leaf; }

  // What a surface keeps is what the path has lost there, so that no path makes or loses light.
  static typename Layout::Total absorbedBy(Surface surface) {
    if (surface == Surface::none) return Layout::absorbed_ground;
    if (isLeaf(surface)) return Layout::absorbed_leaves;
    return surface == Surface::wood ? Layout::absorbed_wood : Layout::absorbed_particles;
  }

  void leave(typename Layout::Leaving how, const BandLanes<N>& weight, int reflections, int passes) {
    addTo(layout_.total(how == Layout::upward ? Layout::reflected : Layout::arriving_ground, 0), weight);
    addTo(layout_.order(how, OrderTable::bin(reflections, passes), 0), weight);
  }

  void arriveDirect(const Hit& hit) {
    if (hit.surface == Surface::none) tally_.add(layout_.direct(), share_);
    if (hit.surface == Surface::leaf) tally_.add(layout_.leafSide(hit.leaf, hit.front) + layout_.bands, share_);
  }

  // Subtracted in double precision, so that nothing gets lost in rounding.
  void keep(std::size_t first, const BandLanes<N>& arriving, const BandLanes<N>& leaving) {
    for (std::size_t band = 0; band < layout_.bands; ++band)
      tally_.add(first + band,
                 share_ * (double{arriving[static_cast<int>(band)]} - double{leaving[static_cast<int>(band)]}));
  }

  // The bins of all bands, one after the other.
  void addTo(std::size_t first, const BandLanes<N>& weight) {
    for (std::size_t band = 0; band < layout_.bands; ++band)
      tally_.add(first + band, share_ * double{weight[static_cast<int>(band)]});
  }

  // Makes of a hit on nothing, on the way down, one on the ground.
  void meetGround(Hit& hit, const glm::vec3& from, const glm::vec3& direction) const {
    hit.position = scene_.wrapped(from + (scene_.low - from.z) / direction.z * direction);
    hit.position.z = scene_.low;
    hit.normal = {0.f, 0.f, 1.f};
  }

  const RayScene::Geometry& scene_;
  const SunlitFaces& faces_;
  Direction sun_;
  const SceneOptics<N>& optics_;
  const Layout& layout_;
  double share_;  // of the incident light that a path starts with
  UnitTally& tally_;
};

}  // namespace

struct ForwardJob::Parts {
  Parts(const RayScene& of, std::vector<TraceLight> of_bands, std::uint64_t per_unit)
      : scene(of.geometry()),
        bands(std::move(of_bands)),
        paths_per_unit(per_unit),
        faces(scene, bands.front().sun),
        optics(bands, scene),
        layout{.bands = bands.size(), .leaves = scene.leaf_area.size()} {}

  const RayScene::Geometry& scene;
  std::vector<TraceLight> bands;
  std::uint64_t paths_per_unit;
  SunlitFaces faces;
  AnyLanes optics;
  Layout layout;
};

ForwardJob::ForwardJob(const RayScene& scene, std::vector<TraceLight> bands, std::uint64_t paths_per_unit) {
  requireFitting(bands, scene);
  require(paths_per_unit >= 1 && paths_per_unit <= kMostUnitPaths, "paths per unit", paths_per_unit,
          "from 1 to " + std::to_string(kMostUnitPaths));
  for (const TraceLight& light : bands)
    require(scene.geometry().period || light.ground_albedo == 0.f, "ground albedo", light.ground_albedo,
            "0 in a forward trace of a stand without period");
  parts_ = std::make_unique<Parts>(scene, std::move(bands), paths_per_unit);
}

ForwardJob::~ForwardJob() = default;

std::size_t ForwardJob::bins() const {
  return parts_->layout.bins();
}

TraceIdentity ForwardJob::identity() const {
  TraceIdentity identity = identityOf(parts_->bands, parts_->scene);
  identity["paths per unit"] = std::to_string(parts_->paths_per_unit);
  return identity;
}

void ForwardJob::trace(std::uint64_t seed, std::uint64_t unit, UnitTally& tally, const Stopped& stopped) const {
  const std::uint64_t count = parts_->paths_per_unit;
  parts_->optics.visit([&](const auto& optics) {
    ForwardPaths paths(parts_->scene, parts_->faces, parts_->bands.front().sun, optics, parts_->layout,
                       1. / static_cast<double>(count), tally);
    const EvenSet set(seed, unit);
    for (std::uint64_t i = 0; i < count && !stopped.load(std::memory_order_relaxed); ++i) {
      PathRandom random(set, unit * count + i, static_cast<std::uint32_t>(i));
      paths.trace(random);
    }
  });
}

std::vector<ForwardResult> ForwardJob::results(const TraceSums& sums) const {
  const Layout& layout = parts_->layout;
  std::vector<ForwardResult> results;
  for (int band = 0; band < static_cast<int>(layout.bands); ++band) {
    ForwardResult& r = results.emplace_back();
    const auto total = [&](Layout::Total which) { return sums.estimate(layout.total(which, band)); };
    r.reflected = total(Layout::reflected);
    r.absorbed_leaves = total(Layout::absorbed_leaves);
    r.absorbed_wood = total(Layout::absorbed_wood);
    if (parts_->scene.hasParticles()) r.absorbed_particles = total(Layout::absorbed_particles);
    r.arriving_ground = total(Layout::arriving_ground);
    r.arriving_ground_direct = sums.estimate(layout.direct());
    r.absorbed_ground = total(Layout::absorbed_ground);
    for (std::size_t bin = 0; bin < OrderTable::kBins; ++bin) {
      r.reflected_by_order.set(bin, sums.estimate(layout.order(Layout::upward, bin, band)));
      r.arriving_ground_by_order.set(bin, sums.estimate(layout.order(Layout::downward, bin, band)));
    }
    for (std::size_t leaf = 0; leaf < layout.leaves; ++leaf) {
      const double per_area = parts_->faces.flux() / parts_->scene.leaf_area[leaf];
      const auto irradiance = [&](bool front, std::size_t at) {
        const Estimate share = sums.estimate(layout.leafSide(leaf, front) + at);
        return Estimate{per_area * share.value, per_area * share.standard_error};
      };
      // Light on one side of a leaf and light on the other come by different paths.
      const auto both = [](const Estimate& a, const Estimate& b) {
        return Estimate{a.value + b.value, std::hypot(a.standard_error, b.standard_error)};
      };
      r.leaf_front.push_back(irradiance(true, static_cast<std::size_t>(band)));
      r.leaf_back.push_back(irradiance(false, static_cast<std::size_t>(band)));
      r.leaf_direct.push_back(both(irradiance(true, layout.bands), irradiance(false, layout.bands)));
      const Estimate whole = both(r.leaf_front.back(), r.leaf_back.back());
      r.leaf_irradiance.push_back(whole.value);
      r.leaf_standard_error.push_back(whole.standard_error);
    }
    r.paths = sums.units() * parts_->paths_per_unit;
  }
  return results;
}

double ForwardJob::relativeError(const TraceSums& sums) const {
  double error = 0.;
  for (std::size_t bin = 0; bin < parts_->layout.direct(); ++bin) {
    const Estimate share = sums.estimate(bin);
    if (share.value >= 0.01) error = std::max(error, share.standard_error / share.value);
  }
  return error;
}

std::vector<ForwardResult> traceForwardBands(const RayScene& scene, const std::vector<TraceLight>& bands,
                                             const TraceEffort& effort, const Progress& progress) {
  validate(effort);
  const Elapsed elapsed;
  const std::uint64_t per_unit = pathsPerUnit(effort.paths);
  const ForwardJob job(scene, bands, per_unit);
  TraceSums sums(job.bins(), job.groups());
  runUnits(job, {.seed = effort.seed, .wanted = {0, unitsOf(effort.paths, per_unit)}, .threads = effort.threads}, sums,
           progress);
  std::vector<ForwardResult> results = job.results(sums);
  for (ForwardResult& result : results) {
    result.seconds = elapsed.seconds();
    result.cpu_seconds = elapsed.cpuSeconds();
  }
  return results;
}

ForwardResult traceForward(const RayScene& scene, const TraceLight& light, const TraceEffort& effort,
                           const Progress& progress) {
  return std::move(traceForwardBands(scene, {light}, effort, progress).front());
}

}  // namespace sunfleck
