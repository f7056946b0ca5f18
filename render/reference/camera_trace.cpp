#include "render/reference/camera_trace.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <type_traits>

#include "core/elapsed.hpp"
#include "core/require.hpp"
#include "render/reference/detail/eye_paths.hpp"
#include "render/reference/detail/identity_text.hpp"
#include "render/reference/trace_run.hpp"

namespace sunfleck {
using namespace detail;
namespace {

constexpr int kTileSide = 32;  // [pixel]
constexpr int kMostSamplesPerUnit = 16;
constexpr int kLeastUnitsOfTile = 8;

// A part of the picture.
struct Tile {
  int left, top, right, bottom;  // [pixel], right and bottom one beyond
  int pixels() const { return (right - left) * (bottom - top); }
};

// Samples traced side by side.
template <int N>
struct Packet {
  static constexpr std::size_t kSize = RayScene::Geometry::kPacket;
  std::vector<glm::vec3> from;
  std::vector<Direction> sights;
  std::vector<PathRandom> random;
  std::vector<int> x, y;  // pixel
  std::vector<Seen<N>> seen{kSize};

  void add(const glm::vec3& start, const Direction& sight, const PathRandom& of_path, int pixel_x, int pixel_y) {
    from.push_back(start);
    sights.push_back(sight);
    random.push_back(of_path);
    x.push_back(pixel_x);
    y.push_back(pixel_y);
  }
  bool full() const { return from.size() == kSize; }
  void clear() {
    from.clear();
    sights.clear();
    random.clear();
    x.clear();
    y.clear();
  }
};

}  // namespace

void validate(const PixelRays& rays) {
  require(rays.width > 0 && rays.width <= 65536, "picture width", rays.width, "from 1 to 65536");
  require(rays.height > 0 && rays.height <= 65536, "picture height", rays.height, "from 1 to 65536");
  const double length = glm::length(glm::dvec3(rays.sight));
  require(std::abs(length - 1.) < 1e-4, "length of the direction of sight", length, "1");
  for (const glm::vec3& v : {rays.corner, rays.right_step, rays.down_step, rays.eye.value_or(glm::vec3(0.f))})
    for (int axis = 0; axis < 3; ++axis)
      require(std::abs(v[axis]) <= 1e7f, "eye, corner or step of the picture's pixels", v[axis],
              "finite and at most 1e7 m");
  if (!rays.eye) return;
  // All places lie before the eye if the corners do.
  const glm::dvec3 right(rays.right_step), down(rays.down_step), corner(rays.corner);
  const double volume = std::abs(glm::dot(glm::cross(right, down), corner));
  require(volume > 1e-6 * glm::length(right) * glm::length(down) * glm::length(corner),
          "distance of the picture's pixels from the eye", volume, "above 0");
}

struct CameraJob::Parts {
  Parts(const RayScene& of, std::vector<TraceLight> of_bands, const PixelRays& of_rays, float ground_height,
        int samples, Followed until)
      : scene(of.geometry()),
        bands(std::move(of_bands)),
        rays(of_rays),
        ground(ground_height - scene.origin.z),
        samples_per_unit(samples),
        followed(until),
        optics(bands, scene),
        light(bands),
        shadows(scene, light.toSun()) {
    (rays.eye ? *rays.eye : rays.corner) -= scene.origin;
    const bool black_beyond = scene.media.empty() && !light.wide() &&
                              std::ranges::none_of(bands, [](const auto& b) { return b.largestGroundAlbedo() > 0.f; });
    if (black_beyond && !rays.eye) before_eye.emplace(scene, -of_rays.sight);
  }

  int tilesAcross() const { return (rays.width + kTileSide - 1) / kTileSide; }
  int tilesDown() const { return (rays.height + kTileSide - 1) / kTileSide; }
  std::uint64_t tiles() const {
    return static_cast<std::uint64_t>(tilesAcross()) * static_cast<std::uint64_t>(tilesDown());
  }
  Tile tile(std::uint64_t number) const {
    const auto across = static_cast<std::uint64_t>(tilesAcross());
    const int left = static_cast<int>(number % across) * kTileSide, top = static_cast<int>(number / across) * kTileSide;
    return {left, top, std::min(left + kTileSide, rays.width), std::min(top + kTileSide, rays.height)};
  }

  // Bins: of each tile, per band, its mean; then of each pixel, per band, all its radiance and what was scattered once.
  std::size_t tileMean(std::uint64_t tile, int band) const {
    return tile * bands.size() + static_cast<std::size_t>(band);
  }
  std::size_t pixel(int x, int y, int band) const {
    const std::size_t number =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(rays.width) + static_cast<std::size_t>(x);
    return tiles() * bands.size() + 2 * (number * bands.size() + static_cast<std::size_t>(band));
  }

  std::uint64_t pathsOf(std::uint64_t tile_number) const {  // of a unit
    return static_cast<std::uint64_t>(tile(tile_number).pixels()) * static_cast<std::uint64_t>(samples_per_unit);
  }
  // Whether there is surely neither a tree nor anything else.
  bool seesNothing(int x, int y) const {
    if (!before_eye) return false;
    const glm::vec3 corner =
        rays.corner + static_cast<float>(x) * rays.right_step + static_cast<float>(y) * rays.down_step;
    return before_eye->nothingThrough(corner, rays.right_step, rays.down_step);
  }

  void setPixels(CameraResult& result, const TraceSums& sums, std::uint64_t tile_number, int band) const;
  CameraResult result(const TraceSums& sums, int band) const;
  std::vector<double> wanted(double target, const TraceSums& sums) const;  // units of each tile, see unitsFor

  const RayScene::Geometry& scene;
  std::vector<TraceLight> bands;
  PixelRays rays;  // about the scene's origin
  float ground;    // height about the scene's origin [m]
  int samples_per_unit;
  Followed followed;
  AnyLanes optics;
  SceneLight light;
  ParallelShadows shadows;                    // of the sun
  std::optional<ParallelShadows> before_eye;  // tells pixels that see nothing, where all is black beyond the trees
};

CameraJob::CameraJob(const RayScene& scene, std::vector<TraceLight> bands, const PixelRays& rays, float ground_height,
                     int samples_per_unit, Followed followed) {
  requireFitting(bands, scene);
  validate(rays);
  require(samples_per_unit >= 1 && samples_per_unit <= kMostSamplesPerUnit, "samples per unit", samples_per_unit,
          "from 1 to " + std::to_string(kMostSamplesPerUnit));
  require(std::isfinite(ground_height), "ground height", ground_height, "finite");
  const RayScene::Geometry& geometry = scene.geometry();
  const bool has_ground =
      std::any_of(bands.begin(), bands.end(), [](const auto& b) { return b.largestGroundAlbedo() > 0.f; });
  if (geometry.period && has_ground)
    require(ground_height <= geometry.stand_box.low.z, "ground height", ground_height,
            "at most the bottom of a periodic stand, " + std::to_string(geometry.stand_box.low.z));
  parts_ = std::make_unique<Parts>(scene, std::move(bands), rays, ground_height, samples_per_unit, followed);
}

CameraJob::~CameraJob() = default;

std::size_t CameraJob::bins() const {
  return parts_->pixel(0, parts_->rays.height, 0);
}

std::uint64_t CameraJob::groups() const {
  return parts_->tiles();
}

std::uint64_t CameraJob::unitsOf(std::uint64_t samples) const {
  return sunfleck::unitsOf(samples, static_cast<std::uint64_t>(parts_->samples_per_unit)) * groups();
}

TraceIdentity CameraJob::identity() const {
  TraceIdentity identity = identityOf(parts_->bands, parts_->scene);
  identity["camera"] = textOf(parts_->rays);
  identity["scattered"] = parts_->followed == Followed::once ? "once" : "at all";
  identity["ground height"] = fmt::format("{}", parts_->ground);
  identity["samples per unit"] = std::to_string(parts_->samples_per_unit);
  return identity;
}

void CameraJob::trace(std::uint64_t seed, std::uint64_t unit, UnitTally& tally, const Stopped& stopped) const {
  const PixelRays& rays = parts_->rays;
  const Tile tile = parts_->tile(unit % groups());
  const auto samples = static_cast<std::uint32_t>(parts_->samples_per_unit);
  const int band_count = static_cast<int>(parts_->bands.size());
  const double share = 1. / samples, share_of_tile = share / tile.pixels();
  parts_->optics.visit([&](const auto& optics) {
    const EyePaths paths(parts_->scene, optics, parts_->light, parts_->shadows, parts_->ground, parts_->followed);
    using Lanes = std::remove_cvref_t<decltype(optics.ground().reflectance)>;
    Packet<Lanes::kBands> packet;
    const auto finish = [&] {
      paths.look(packet.from, packet.sights, packet.random, packet.seen);
      for (std::size_t i = 0; i < packet.random.size(); ++i)
        for (int band = 0; band < band_count; ++band) {
          const Seen<Lanes::kBands>& seen = packet.seen[i];
          const double once =
              double{seen.leaf_once[band]} + double{seen.wood_once[band]} + double{seen.ground_once[band]};
          const double radiance = once + double{seen.more[band]} + double{seen.light[band]};
          if (radiance == 0.) continue;
          const std::size_t pixel = parts_->pixel(packet.x[i], packet.y[i], band);
          tally.add(pixel, share * radiance);
          tally.add(pixel + 1, share * once);
          tally.add(parts_->tileMean(unit % groups(), band), share_of_tile * radiance);
        }
      packet.clear();
    };
    std::uint64_t pixel_of_run = unit * kTileSide * kTileSide;
    for (int y = tile.top; y < tile.bottom; ++y)
      for (int x = tile.left; x < tile.right && !stopped.load(std::memory_order_relaxed); ++x, ++pixel_of_run) {
        if (parts_->seesNothing(x, y)) continue;
        const EvenSet set(Stream::picture, seed, pixel_of_run);
        for (std::uint32_t i = 0; i < samples; ++i) {
          PathRandom random(set, pixel_of_run * samples + i, i);
          const Pair at = random.pair();
          const glm::vec3 place = rays.corner + (static_cast<float>(x) + at.u) * rays.right_step +
                                  (static_cast<float>(y) + at.v) * rays.down_step;
          const Direction sight = rays.eye ? glm::normalize(place) : rays.sight;
          packet.add(rays.eye ? paths.startBefore(*rays.eye, sight) : paths.startOf(place, sight), sight, random, x, y);
          if (packet.full()) finish();
        }
      }
    if (!packet.from.empty()) finish();
  });
}

void CameraJob::Parts::setPixels(CameraResult& result, const TraceSums& sums, std::uint64_t number, int band) const {
  const Tile of = tile(number);
  for (int y = of.top; y < of.bottom; ++y)
    for (int x = of.left; x < of.right; ++x) {
      const Estimate radiance = sums.estimate(pixel(x, y, band), number);
      const std::size_t at =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(rays.width) + static_cast<std::size_t>(x);
      result.radiance.values[2 * at] = static_cast<float>(radiance.value);
      result.radiance.values[2 * at + 1] = static_cast<float>(sums.estimate(pixel(x, y, band) + 1, number).value);
      result.standard_error.values[at] = static_cast<float>(radiance.standard_error);
    }
}

CameraResult CameraJob::Parts::result(const TraceSums& sums, int band) const {
  CameraResult result;
  result.radiance = {.width = rays.width, .height = rays.height, .channels = {"Y", "single.Y"}, .values = {}};
  result.standard_error = {.width = rays.width, .height = rays.height, .channels = {"Y"}, .values = {}};
  const std::size_t pixels = static_cast<std::size_t>(rays.width) * static_cast<std::size_t>(rays.height);
  result.radiance.values.resize(2 * pixels);
  result.standard_error.values.resize(pixels);
  double sum = 0., variance = 0., pixels_met = 0.;
  for (std::uint64_t number = 0; number < tiles(); ++number) {
    const std::uint64_t units = sums.units(number);
    if (units == 0) continue;
    const double weight = tile(number).pixels();
    const Estimate mean = sums.estimate(tileMean(number, band), number);
    pixels_met += weight;
    sum += weight * mean.value;
    variance += std::pow(weight * mean.standard_error, 2);
    result.paths += units * pathsOf(number);
    setPixels(result, sums, number, band);
  }
  if (pixels_met > 0.) result.mean = {sum / pixels_met, std::sqrt(variance) / pixels_met};
  return result;
}

std::uint64_t CameraJob::pathsOf(std::uint64_t unit) const {
  return parts_->pathsOf(unit % groups());
}

std::vector<CameraResult> CameraJob::results(const TraceSums& sums) const {
  std::vector<CameraResult> results;
  for (int band = 0; band < static_cast<int>(parts_->bands.size()); ++band)
    results.push_back(parts_->result(sums, band));
  return results;
}

void CameraJob::refresh(std::vector<CameraResult>& results, const TraceSums& sums, std::uint64_t tile) const {
  for (std::size_t band = 0; band < results.size(); ++band)
    parts_->setPixels(results[band], sums, tile, static_cast<int>(band));
}

// With v the sum over a tile's pixels of the variance that a unit leaves, n units of each tile leave sum v / n. For the
// least work, n goes as sqrt(v).
std::vector<double> CameraJob::Parts::wanted(double target, const TraceSums& sums) const {
  const double pixels = double(rays.width) * double(rays.height);
  std::vector<double> wanted(tiles(), double{kLeastUnitsOfTile});
  for (int band = 0; band < static_cast<int>(bands.size()); ++band) {
    std::vector<double> deviation(tiles());  // sqrt(v)
    double deviations = 0., radiance = 0.;
    for (std::uint64_t number = 0; number < tiles(); ++number) {
      const Tile of = tile(number);
      double variance = 0.;
      for (int y = of.top; y < of.bottom; ++y)
        for (int x = of.left; x < of.right; ++x)
          variance += std::pow(sums.estimate(pixel(x, y, band), number).standard_error, 2);
      deviation[number] = std::sqrt(variance * static_cast<double>(sums.units(number)));
      deviations += deviation[number];
      radiance += of.pixels() * sums.estimate(tileMean(number, band), number).value;
    }
    const double allowed = std::pow(target * radiance / pixels, 2) * pixels;  // sum over pixels of squared errors
    for (std::uint64_t number = 0; number < tiles() && allowed > 0.; ++number)
      wanted[number] = std::max(wanted[number], deviation[number] * deviations / allowed);
  }
  return wanted;
}

UnitRanges CameraJob::unitsFor(double target, std::uint64_t most, const TraceSums& sums, std::uint64_t seed) const {
  const std::vector<double> wanted = parts_->wanted(target, sums);
  UnitRanges units;
  for (std::uint64_t number = 0; number < groups(); ++number) {
    const std::uint64_t done = sums.units(number);
    // At most twice what there is, as what is known of the noise is noisy itself.
    const double least = double{kLeastUnitsOfTile}, twice = std::max(least, 2. * static_cast<double>(done));
    const auto goal =
        static_cast<std::uint64_t>(std::min({std::ceil(wanted[number]), twice, static_cast<double>(most)}));
    addMissing(units, goal - std::min(goal, done), sums.done(seed), number, groups());
  }
  return units;
}

bool CameraJob::reached(double target, const TraceSums& sums) const {
  const std::vector<double> wanted = parts_->wanted(target, sums);
  for (std::uint64_t number = 0; number < groups(); ++number)
    if (static_cast<double>(sums.units(number)) < wanted[number]) return false;
  return true;
}

int samplesPerUnit(std::uint64_t samples) {
  return static_cast<int>(
      std::clamp<std::uint64_t>(std::bit_floor(samples / kLeastUnitsOfTile), 1, kMostSamplesPerUnit));
}

std::vector<CameraResult> traceCameraBands(const RayScene& scene, const std::vector<TraceLight>& bands,
                                           const PixelRays& rays, float ground_height, const TraceEffort& effort,
                                           const Progress& progress) {
  validate(effort);
  validate(rays);
  const Elapsed elapsed;
  const std::uint64_t samples =
      unitsOf(effort.paths, static_cast<std::uint64_t>(rays.width) * static_cast<std::uint64_t>(rays.height));
  const CameraJob job(scene, bands, rays, ground_height, samplesPerUnit(samples));
  TraceSums sums(job.bins(), job.groups());
  runUnits(job, {.seed = effort.seed, .wanted = {0, job.unitsOf(samples)}, .threads = effort.threads}, sums, progress);
  std::vector<CameraResult> results = job.results(sums);
  for (CameraResult& result : results) {
    result.seconds = elapsed.seconds();
    result.cpu_seconds = elapsed.cpuSeconds();
  }
  return results;
}

CameraResult traceCamera(const RayScene& scene, const TraceLight& light, const PixelRays& rays, float ground_height,
                         const TraceEffort& effort, const Progress& progress) {
  return std::move(traceCameraBands(scene, {light}, rays, ground_height, effort, progress).front());
}

}  // namespace sunfleck
