#include "render/reference/forward_trace.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/elapsed.hpp"
#include "core/require.hpp"
#include "render/reference/detail/identity_text.hpp"
#include "render/reference/detail/incident_light.hpp"
#include "render/reference/detail/scattering.hpp"
#include "render/reference/detail/scene_geometry.hpp"
#include "render/reference/detail/scene_optics.hpp"
#include "render/reference/trace_run.hpp"

namespace sunfleck {
using namespace detail;
namespace {

// Where each number is kept among the bins of a run of B bands.
struct Layout {
  std::size_t bands, leaves, cells;  // leaves, cells: as many as are kept
  std::size_t direct_bands;          // of direct light: one for all bands where it is the same share in all, or each

  enum Total { reflected, absorbed_leaves, absorbed_wood, absorbed_ground, absorbed_particles, arriving_ground };
  static constexpr std::size_t kTotals = 6;
  std::size_t total(Total which, int band) const { return which * bands + index(band); }
  std::size_t direct() const { return kTotals * bands; }
  std::size_t directBand(int band) const { return direct_bands == 1 ? 0 : index(band); }

  enum Leaving { upward, downward };
  std::size_t orders(Leaving how) const { return direct() + direct_bands + how * OrderTable::kBins * bands; }
  std::size_t order(Leaving how, std::size_t bin, int band) const { return orders(how) + bin * bands + index(band); }

  // Of each leaf: the light of each band on its front, on its back, and on both; and the direct on both.
  std::size_t firstLeaf() const { return orders(downward) + OrderTable::kBins * bands; }
  std::size_t ofLeaf() const { return 3 * bands + direct_bands; }
  std::size_t leafSide(std::size_t leaf, bool front) const {
    return firstLeaf() + leaf * ofLeaf() + (front ? 0 : bands);
  }
  std::size_t leafBoth(std::size_t leaf) const { return leafSide(leaf, true) + 2 * bands; }
  std::size_t leafDirect(std::size_t leaf) const { return leafBoth(leaf) + bands; }
  // Of each cell, what its leaves and what its wood absorb of each band.
  std::size_t inCell(std::size_t cell, Total which) const {
    return leafSide(leaves, true) + (2 * cell + (which == absorbed_leaves ? 0 : 1)) * bands;
  }
  std::size_t bins() const { return inCell(cells, absorbed_leaves); }

  // The bin of both sides of a leaf that the bin of one is part of; none if it is another.
  std::optional<std::size_t> bothOf(std::size_t bin) const {
    if (bin < firstLeaf() || bin >= leafSide(leaves, true)) return {};
    const std::size_t first = (bin - firstLeaf()) % ofLeaf();
    if (first >= 2 * bands) return {};
    return bin + (first < bands ? 2 : 1) * bands;
  }

 private:
  static std::size_t index(int band) { return static_cast<std::size_t>(band); }
};

// One path may meet both sides of a leaf: what a unit found on both goes into a bin of its own, whose spread tells how
// sure it is.
void addBothSides(const Layout& layout, UnitTally& tally) {
  const std::vector<std::uint32_t> met(tally.met().begin(), tally.met().end());
  for (const std::uint32_t bin : met)
    if (const std::optional<std::size_t> both = layout.bothOf(bin)) tally.add(*both, tally.value(bin));
}

template <int N>
class ForwardPaths {
 public:
  ForwardPaths(const RayScene::Geometry& scene, const IncidentLight& light, const SceneOptics<N>& optics,
               const Layout& layout, const TraceCells* cells, double share, UnitTally& tally)
      : scene_(scene), light_(light), optics_(optics), layout_(layout), cells_(cells), share_(share), tally_(tally) {}

  void trace(PathRandom& random) {
    auto [from, direction, weight] = light_.enter<N>(random);
    int reflections = 0, passes = 0;
    for (int scatterings = 0;; ++scatterings) {
      Hit hit = scene_.meet(from, direction, random);
      const bool none = hit.surface == Surface::none;
      if (none) leave(direction.z >= 0.f ? Layout::upward : Layout::downward, weight, reflections, passes);
      if (none && direction.z >= 0.f) return;
      if (none) meetGround(hit, from, direction);
      if (scatterings == 0) arriveDirect(hit, weight);
      if (keepsLeaf(hit)) addTo(layout_.leafSide(hit.leaf, hit.front), weight);
      const BandLanes<N> arriving = weight;
      Onward onward = optics_.scatter(hit, direction, weight, random);
      if (scatterings == kMostScatterings) onward.fate = Fate::absorbed;
      const Fate fate = onward.fate;
      if (fate == Fate::absorbed) weight = {};
      const typename Layout::Total absorber = absorbedBy(hit.surface);
      keep(layout_.total(absorber, 0), arriving, weight);
      if (cells_ && absorber != Layout::absorbed_ground)
        keep(layout_.inCell(cells_->at(hit.position), absorber), arriving, weight);
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

  void arriveDirect(const Hit& hit, const BandLanes<N>& weight) {
    if (hit.surface != Surface::none && !keepsLeaf(hit)) return;
    const std::size_t first = hit.surface == Surface::none ? layout_.direct() : layout_.leafDirect(hit.leaf);
    for (std::size_t i = 0; i < layout_.direct_bands; ++i)
      tally_.add(first + i, share_ * double{weight[static_cast<int>(i)]});
  }

  bool keepsLeaf(const Hit& hit) const { return hit.surface == Surface::leaf && layout_.leaves > 0; }

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
  const IncidentLight& light_;
  const SceneOptics<N>& optics_;
  const Layout& layout_;
  const TraceCells* cells_;  // none where they are not asked for
  double share_;             // of the incident light that a path starts with
  UnitTally& tally_;
};

}  // namespace

struct ForwardJob::Parts {
  Parts(const RayScene& of, std::vector<TraceLight> of_bands, std::uint64_t per_unit, ForwardDetail detail)
      : scene(of.geometry()),
        bands(std::move(of_bands)),
        paths_per_unit(per_unit),
        light(scene, bands),
        optics(bands, scene),
        cells(detail.cells),
        layout{.bands = bands.size(),
               .leaves = detail.leaves ? scene.leaf_area.size() : 0,
               .cells = cells ? cells->count() : 0,
               .direct_bands = light.sameInAllBands() ? 1 : bands.size()} {}

  const RayScene::Geometry& scene;
  std::vector<TraceLight> bands;
  std::uint64_t paths_per_unit;
  IncidentLight light;
  AnyLanes optics;
  std::optional<TraceCells> cells;
  Layout layout;
};

ForwardJob::ForwardJob(const RayScene& scene, std::vector<TraceLight> bands, std::uint64_t paths_per_unit,
                       ForwardDetail detail) {
  requireFitting(bands, scene);
  require(paths_per_unit >= 1 && paths_per_unit <= kMostUnitPaths, "paths per unit", paths_per_unit,
          "from 1 to " + std::to_string(kMostUnitPaths));
  for (const TraceLight& light : bands)
    require(scene.geometry().period || light.largestGroundAlbedo() == 0.f, "ground albedo", light.largestGroundAlbedo(),
            "0 in a forward trace of a stand without period");
  parts_ = std::make_unique<Parts>(scene, std::move(bands), paths_per_unit, std::move(detail));
}

ForwardJob::~ForwardJob() = default;

std::size_t ForwardJob::bins() const {
  return parts_->layout.bins();
}

TraceIdentity ForwardJob::identity() const {
  TraceIdentity identity = identityOf(parts_->bands, parts_->scene);
  identity["paths per unit"] = std::to_string(parts_->paths_per_unit);
  if (parts_->cells) identity["side of the cells"] = fmt::format("{}", parts_->cells->side());
  return identity;
}

void ForwardJob::trace(std::uint64_t seed, std::uint64_t unit, UnitTally& tally, const Stopped& stopped) const {
  const std::uint64_t count = parts_->paths_per_unit;
  parts_->optics.visit([&](const auto& optics) {
    ForwardPaths paths(parts_->scene, parts_->light, optics, parts_->layout, parts_->cells ? &*parts_->cells : nullptr,
                       1. / static_cast<double>(count), tally);
    const EvenSet set(Stream::light, seed, unit);
    for (std::uint64_t i = 0; i < count && !stopped.load(std::memory_order_relaxed); ++i) {
      PathRandom random(set, unit * count + i, static_cast<std::uint32_t>(i));
      paths.trace(random);
    }
  });
  addBothSides(parts_->layout, tally);
}

std::vector<ForwardResult> ForwardJob::results(const TraceSums& sums) const {
  const Layout& layout = parts_->layout;
  std::vector<ForwardResult> results;
  for (int band = 0; band < static_cast<int>(layout.bands); ++band) {
    ForwardResult& r = results.emplace_back();
    r.sky_share = parts_->light.skyShare(band);
    const auto total = [&](Layout::Total which) { return sums.estimate(layout.total(which, band)); };
    r.reflected = total(Layout::reflected);
    r.absorbed_leaves = total(Layout::absorbed_leaves);
    r.absorbed_wood = total(Layout::absorbed_wood);
    if (parts_->scene.hasParticles()) r.absorbed_particles = total(Layout::absorbed_particles);
    r.arriving_ground = total(Layout::arriving_ground);
    r.arriving_ground_direct = sums.estimate(layout.direct() + layout.directBand(band));
    r.absorbed_ground = total(Layout::absorbed_ground);
    for (std::size_t bin = 0; bin < OrderTable::kBins; ++bin) {
      r.reflected_by_order.set(bin, sums.estimate(layout.order(Layout::upward, bin, band)));
      r.arriving_ground_by_order.set(bin, sums.estimate(layout.order(Layout::downward, bin, band)));
    }
    for (std::size_t leaf = 0; leaf < layout.leaves; ++leaf) {
      const double per_area = parts_->light.flux(band) / parts_->scene.leaf_area[leaf];
      const auto irradiance = [&](std::size_t bin) {
        const Estimate share = sums.estimate(bin);
        return Estimate{per_area * share.value, per_area * share.standard_error};
      };
      const auto at = static_cast<std::size_t>(band);
      r.leaf_front.push_back(irradiance(layout.leafSide(leaf, true) + at));
      r.leaf_back.push_back(irradiance(layout.leafSide(leaf, false) + at));
      r.leaf_direct.push_back(irradiance(layout.leafDirect(leaf) + layout.directBand(band)));
      const Estimate whole = irradiance(layout.leafBoth(leaf) + at);
      r.leaf_irradiance.push_back(whole.value);
      r.leaf_standard_error.push_back(whole.standard_error);
    }
    r.paths = sums.units() * parts_->paths_per_unit;
  }
  return results;
}

std::vector<CellAbsorption> ForwardJob::cells(const TraceSums& sums, std::size_t band) const {
  const Layout& layout = parts_->layout;
  std::vector<CellAbsorption> met;
  for (std::size_t cell = 0; cell < layout.cells; ++cell) {
    const Estimate leaves = sums.estimate(layout.inCell(cell, Layout::absorbed_leaves) + band);
    const Estimate wood = sums.estimate(layout.inCell(cell, Layout::absorbed_wood) + band);
    // Below 0 by noise: where a path's weight is in other bands, it may leave with more of this one than it brought.
    if (leaves.value != 0. || wood.value != 0.) met.push_back({cell, leaves, wood});
  }
  return met;
}

double ForwardJob::incidentFlux(int band) const {
  return parts_->light.flux(band);
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
