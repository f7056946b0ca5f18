#include "render/reference/brf_trace.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/require.hpp"
#include "render/reference/detail/eye_paths.hpp"
#include "render/reference/detail/identity_text.hpp"
#include "render/reference/trace_effort.hpp"

namespace sunfleck {
using namespace detail;
namespace {

constexpr std::uint64_t kLeastUnitsOfView = 16;
constexpr std::size_t kPartsOfView = 5;

}  // namespace

struct BrfJob::Parts {
  Parts(const RayScene& of, std::vector<TraceLight> of_bands, std::vector<ViewDirection> of_views,
        std::uint64_t per_unit)
      : scene(of.geometry()),
        bands(std::move(of_bands)),
        views(std::move(of_views)),
        paths_per_unit(per_unit),
        optics(bands, scene),
        light(bands),
        shadows(scene, light.toSun()) {
    for (const ViewDirection& view : views)
      sights.push_back(sunlight(static_cast<float>(view.zenith), static_cast<float>(view.azimuth)));
    for (const TraceLight& band : bands)
      irradiance.push_back(-double{band.sun.z} * double{band.sun_irradiance} +
                           (band.sky ? band.sky->irradiance()[band.sky_band] : 0.));
  }

  std::uint64_t groups() const { return views.size() + 1; }
  // Of a view, per band: the whole and its parts.
  std::size_t bin(std::uint64_t group, int band) const {
    return kPartsOfView * (group * bands.size() + static_cast<std::size_t>(band));
  }
  // A point at the top of the traced period, where all lines of sight come down evenly.
  glm::vec3 onTop(const Pair& at) const {
    return {scene.box.low.x + at.u * scene.period->x, scene.box.low.y + at.v * scene.period->y, scene.high};
  }
  ReflectanceParts parts(const TraceSums& sums, std::uint64_t group, int band) const {
    const auto part = [&](std::size_t which) { return sums.estimate(bin(group, band) + which, group); };
    return {.whole = part(0), .leaf_once = part(1), .wood_once = part(2), .ground_once = part(3), .more = part(4)};
  }

  // Units of a view that bring its error to the target, by what is known of its noise.
  double wanted(double target, const TraceSums& sums, std::uint64_t group) const;

  const RayScene::Geometry& scene;
  std::vector<TraceLight> bands;
  std::vector<ViewDirection> views;
  std::vector<Direction> sights;  // from the viewer to the stand
  std::uint64_t paths_per_unit;
  AnyLanes optics;
  SceneLight light;
  ParallelShadows shadows;         // of the sun
  std::vector<double> irradiance;  // of a horizontal plane, of each band [1]
};

BrfJob::BrfJob(const RayScene& scene, std::vector<TraceLight> bands, std::vector<ViewDirection> views,
               std::uint64_t paths_per_unit) {
  requireFitting(bands, scene);
  if (!scene.geometry().period) throw InvalidInput("reflectance factors: must be of a periodic stand");
  require(paths_per_unit >= 1 && paths_per_unit <= kMostUnitPaths, "paths per unit", paths_per_unit,
          "from 1 to " + std::to_string(kMostUnitPaths));
  require(!views.empty() && views.size() <= kMostViews, "number of view directions", views.size(),
          "from 1 to " + std::to_string(kMostViews));
  for (const ViewDirection& view : views) {
    require(view.zenith >= 0. && view.zenith <= kMostViewZenith, "view zenith", view.zenith,
            "from 0 to 89 degrees, in radians");
    require(std::abs(view.azimuth) <= 100., "view azimuth", view.azimuth, "in [-100, 100] rad");
  }
  parts_ = std::make_unique<Parts>(scene, std::move(bands), std::move(views), paths_per_unit);
}

BrfJob::~BrfJob() = default;

std::size_t BrfJob::bins() const {
  return parts_->bin(groups(), 0);
}

std::uint64_t BrfJob::groups() const {
  return parts_->groups();
}

std::uint64_t BrfJob::unitsOf(std::uint64_t paths) const {
  return sunfleck::unitsOf(paths, parts_->paths_per_unit) * groups();
}

TraceIdentity BrfJob::identity() const {
  TraceIdentity identity = identityOf(parts_->bands, parts_->scene);
  std::string views;
  for (const ViewDirection& view : parts_->views) views += fmt::format("{} {}; ", view.zenith, view.azimuth);
  identity["views"] = views;
  identity["paths per unit"] = std::to_string(parts_->paths_per_unit);
  return identity;
}

// Lines of sight cross the top of the period evenly, so that the mean of their radiance is the stand's. Drawn by the
// law of cosines, views make the mean of their reflectance factors the albedo.
void BrfJob::trace(std::uint64_t seed, std::uint64_t unit, UnitTally& tally, const Stopped& stopped) const {
  const std::uint64_t group = unit % groups(), count = parts_->paths_per_unit;
  const bool drawn = group == parts_->views.size();
  parts_->optics.visit([&](const auto& optics) {
    const EyePaths paths(parts_->scene, optics, parts_->light, parts_->shadows, parts_->scene.low);
    const EvenSet set(Stream::reflectance, seed, unit);
    for (std::uint64_t i = 0; i < count && !stopped.load(std::memory_order_relaxed); ++i) {
      PathRandom random(set, unit * count + i, static_cast<std::uint32_t>(i));
      const glm::vec3 from = parts_->onTop(random.pair());
      const Direction sight = drawn ? lambertDirection({0.f, 0.f, -1.f}, random) : parts_->sights[group];
      const auto seen = paths.look(from, sight, random);
      for (int band = 0; band < static_cast<int>(parts_->bands.size()); ++band) {
        const double factor =
            std::numbers::pi / (parts_->irradiance[static_cast<std::size_t>(band)] * static_cast<double>(count));
        const std::array parts{double{seen.leaf_once[band]}, double{seen.wood_once[band]},
                               double{seen.ground_once[band]}, double{seen.more[band]}};
        const std::size_t first = parts_->bin(group, band);
        for (std::size_t part = 0; part < parts.size(); ++part) {
          tally.add(first, factor * parts[part]);
          tally.add(first + 1 + part, factor * parts[part]);
        }
      }
    }
  });
}

std::vector<BrfResult> BrfJob::results(const TraceSums& sums) const {
  std::vector<BrfResult> results;
  for (int band = 0; band < static_cast<int>(parts_->bands.size()); ++band) {
    BrfResult& result = results.emplace_back();
    for (std::uint64_t view = 0; view < parts_->views.size(); ++view)
      result.views.push_back(parts_->parts(sums, view, band));
    result.albedo = parts_->parts(sums, parts_->views.size(), band);
    result.paths = sums.units() * parts_->paths_per_unit;
  }
  return results;
}

double BrfJob::Parts::wanted(double target, const TraceSums& sums, std::uint64_t group) const {
  double wanted = double{kLeastUnitsOfView};
  for (int band = 0; band < static_cast<int>(bands.size()); ++band) {
    const Estimate factor = sums.estimate(bin(group, band), group);
    if (factor.value > 0.)
      wanted = std::max(wanted, static_cast<double>(sums.units(group)) *
                                    std::pow(factor.standard_error / (target * factor.value), 2));
  }
  return wanted;
}

UnitRanges BrfJob::unitsFor(double target, std::uint64_t most, const TraceSums& sums, std::uint64_t seed) const {
  UnitRanges units;
  for (std::uint64_t group = 0; group < groups(); ++group) {
    const std::uint64_t done = sums.units(group);
    // At most twice what there is, as what is known of the noise is noisy itself.
    const double wanted = parts_->wanted(target, sums, group);
    const double twice = std::max(double{kLeastUnitsOfView}, 2. * static_cast<double>(done));
    const auto goal = static_cast<std::uint64_t>(std::min({std::ceil(wanted), twice, static_cast<double>(most)}));
    addMissing(units, goal - std::min(goal, done), sums.done(seed), group, groups());
  }
  return units;
}

bool BrfJob::reached(double target, const TraceSums& sums) const {
  for (std::uint64_t group = 0; group < groups(); ++group)
    if (static_cast<double>(sums.units(group)) < parts_->wanted(target, sums, group)) return false;
  return true;
}

}  // namespace sunfleck
