#include "render/reference/light_picture.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/require.hpp"
#include "render/reference/detail/identity_text.hpp"
#include "render/reference/detail/incident_light.hpp"
#include "render/reference/detail/parallel_shadows.hpp"
#include "render/reference/detail/pixel_of_point.hpp"
#include "render/reference/detail/scene_optics.hpp"
#include "render/reference/trace_effort.hpp"

namespace sunfleck {
using namespace detail;
namespace {

// Share of a stand that a picture must show, as its box appears in it, for paths of light to be worth their while.
constexpr double kLeastShown = 0.5;
// The least distance of a stand's box from the eye, as a share of the largest: few paths pass what is near, and each of
// them counts much.
constexpr float kNearest = 1.f / 3.f;

// The stand's box as the picture sees it.
struct BoxInPicture {
  glm::vec2 low{std::numeric_limits<float>::infinity()}, high{-low};            // [pixel]
  float nearest = std::numeric_limits<float>::infinity(), farthest = -nearest;  // see PixelOfPoint::place
};

BoxInPicture inPicture(const Bounds& box, const PixelOfPoint& pixels) {
  BoxInPicture seen;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 at = pixels.place({corner & 1 ? box.low.x : box.high.x, corner & 2 ? box.low.y : box.high.y,
                                       corner & 4 ? box.low.z : box.high.z});
    seen.low = glm::min(seen.low, glm::vec2(at));
    seen.high = glm::max(seen.high, glm::vec2(at));
    seen.nearest = std::min(seen.nearest, at.z);
    seen.farthest = std::max(seen.farthest, at.z);
  }
  return seen;
}

template <int N>
class PicturePaths {
 public:
  //   share  of the incident light that a path starts with, by the area of a pixel's beam [1/m^2]
  //   flux   of each band's incident light [m^2]
  PicturePaths(const RayScene::Geometry& scene, const IncidentLight& light, const SceneOptics<N>& optics,
               const PixelOfPoint& pixels, const std::optional<ParallelShadows>& shadows, double share,
               std::size_t bands, UnitTally& tally)
      : scene_(scene),
        light_(light),
        optics_(optics),
        pixels_(pixels),
        shadows_(shadows),
        bands_(bands),
        tally_(tally) {
    for (std::size_t band = 0; band < bands; ++band)
      flux_[static_cast<int>(band)] = static_cast<float>(share * light.flux(static_cast<int>(band)));
  }

  void trace(PathRandom& random) {
    auto [from, direction, weight] = light_.enter<N>(random);
    for (int scatterings = 0; scatterings < kMostScatterings; ++scatterings) {
      const Hit hit = scene_.meet(from, direction, random);
      if (hit.surface == Surface::none) return;
      const std::optional<Sent> sent = scatterings > 0 ? send(hit, direction, weight) : std::nullopt;
      const Onward onward = optics_.scatter(hit, direction, weight, random);
      if (sent) show(*sent);
      if (onward.fate == Fate::absorbed) return;
      from = scene_.leave(hit.position, onward.side);
      direction = onward.direction;
    }
  }

 private:
  // What goes to the camera of the light that a path brings to a surface.
  struct Sent {
    std::size_t pixel;
    BandLanes<N> radiance;
    Direction to_eye;
    ParallelShadows::Point from;
  };

  // With flux F arriving, what is met sends F f cos per solid angle to the camera, the BRDF or BTDF f being the same
  // both ways: over the area of the pixel's beam, its radiance.
  std::optional<Sent> send(const Hit& hit, const glm::vec3& direction, const BandLanes<N>& weight) const {
    const std::optional<PixelOfPoint::Seen> seen = pixels_.seen(hit.position);
    if (!seen) return std::nullopt;
    BandLanes<N> radiance = optics_.sent(hit, direction, seen->to_eye);
    radiance *= weight;
    if (!(radiance.largest() > 0.f)) return std::nullopt;
    radiance *= flux_;
    radiance *= 1.f / seen->beam;
    const glm::vec3 side = glm::dot(hit.normal, seen->to_eye) > 0.f ? hit.normal : -hit.normal;
    const glm::vec3 from = scene_.leave(hit.position, side);
    return Sent{seen->pixel, radiance, seen->to_eye,
                shadows_ ? shadows_->fetch(from) : ParallelShadows::Point{.from = from}};
  }

  void show(Sent sent) {
    const glm::vec3& from = sent.from.from;
    if (shadows_ ? shadows_->blocked(sent.from) : scene_.blocked(from, sent.to_eye)) return;
    if (!scene_.media.empty()) sent.radiance *= scene_.transmittance(from, sent.to_eye);
    for (std::size_t band = 0; band < bands_; ++band)
      tally_.add(sent.pixel * bands_ + band, double{sent.radiance[static_cast<int>(band)]});
  }

  const RayScene::Geometry& scene_;
  const IncidentLight& light_;
  const SceneOptics<N>& optics_;
  const PixelOfPoint& pixels_;
  const std::optional<ParallelShadows>& shadows_;  // what hides from the eye, where lines of sight are parallel
  BandLanes<N> flux_;                              // of a path, by the area of a pixel's beam [1]
  std::size_t bands_;
  UnitTally& tally_;
};

}  // namespace

struct LightPictureJob::Parts {
  Parts(const RayScene& of, std::vector<TraceLight> of_bands, const PixelRays& of_rays, std::uint64_t per_unit)
      : scene(of.geometry()),
        bands(std::move(of_bands)),
        rays(of_rays),
        paths_per_unit(per_unit),
        light(scene, bands),
        optics(bands, scene) {
    (rays.eye ? *rays.eye : rays.corner) -= scene.origin;
    if (!rays.eye) shadows.emplace(scene, -of_rays.sight);
  }
  std::size_t pixels() const { return static_cast<std::size_t>(rays.width) * static_cast<std::size_t>(rays.height); }

  const RayScene::Geometry& scene;
  std::vector<TraceLight> bands;
  PixelRays rays;  // about the scene's origin
  std::uint64_t paths_per_unit;
  IncidentLight light;
  AnyLanes optics;
  std::optional<ParallelShadows> shadows;
};

bool LightPictureJob::suits(const RayScene& scene, const std::vector<TraceLight>& bands, const PixelRays& rays) {
  const RayScene::Geometry& geometry = scene.geometry();
  if (geometry.period || std::ranges::any_of(bands, [](const auto& b) { return b.largestGroundAlbedo() > 0.f; }))
    return false;
  const PixelOfPoint pixels(rays);
  const auto [low, high, nearest, farthest] = inPicture(scene.box(), pixels);
  if (rays.eye && !(nearest > kNearest * farthest)) return false;
  const glm::dvec2 shown = glm::max(
      glm::dvec2(0.), glm::dvec2(glm::min(high, glm::vec2(rays.width, rays.height)) - glm::max(low, glm::vec2(0.f))));
  const glm::dvec2 all(high - low);
  return shown.x * shown.y >= kLeastShown * all.x * all.y;
}

LightPictureJob::LightPictureJob(const RayScene& scene, std::vector<TraceLight> bands, const PixelRays& rays,
                                 std::uint64_t paths_per_unit) {
  requireFitting(bands, scene);
  validate(rays);
  require(paths_per_unit >= 1 && paths_per_unit <= kMostUnitPaths, "paths per unit", paths_per_unit,
          "from 1 to " + std::to_string(kMostUnitPaths));
  if (scene.geometry().period) throw InvalidInput("picture by paths of light: must be of a stand without period");
  for (const TraceLight& light : bands)
    require(light.largestGroundAlbedo() == 0.f, "ground albedo", light.largestGroundAlbedo(),
            "0 in a picture by paths of light");
  if (rays.eye && !(inPicture(scene.box(), PixelOfPoint(rays)).nearest > 0.f))
    throw InvalidInput("picture by paths of light: must have all of the stand before the eye");
  parts_ = std::make_unique<Parts>(scene, std::move(bands), rays, paths_per_unit);
}

LightPictureJob::~LightPictureJob() = default;

// Of each pixel, each band.
std::size_t LightPictureJob::bins() const {
  return parts_->pixels() * parts_->bands.size();
}

TraceIdentity LightPictureJob::identity() const {
  TraceIdentity identity = identityOf(parts_->bands, parts_->scene);
  identity["camera"] = textOf(parts_->rays);
  identity["paths per unit"] = std::to_string(parts_->paths_per_unit);
  return identity;
}

void LightPictureJob::trace(std::uint64_t seed, std::uint64_t unit, UnitTally& tally, const Stopped& stopped) const {
  const std::uint64_t count = parts_->paths_per_unit;
  const PixelOfPoint pixels(parts_->rays);
  parts_->optics.visit([&](const auto& optics) {
    PicturePaths paths(parts_->scene, parts_->light, optics, pixels, parts_->shadows,
                       1. / (static_cast<double>(count) * pixels.beam()), parts_->bands.size(), tally);
    const EvenSet set(Stream::light_picture, seed, unit);
    for (std::uint64_t i = 0; i < count && !stopped.load(std::memory_order_relaxed); ++i) {
      PathRandom random(set, unit * count + i, static_cast<std::uint32_t>(i));
      paths.trace(random);
    }
  });
}

std::vector<CameraResult> LightPictureJob::results(const TraceSums& sums) const {
  const PixelRays& rays = parts_->rays;
  const std::size_t pixels = parts_->pixels(), bands = parts_->bands.size();
  std::vector<CameraResult> results;
  for (std::size_t band = 0; band < bands; ++band) {
    CameraResult& result = results.emplace_back();
    result.radiance = {.width = rays.width, .height = rays.height, .channels = {"Y", "single.Y"}, .values = {}};
    result.standard_error = {.width = rays.width, .height = rays.height, .channels = {"Y"}, .values = {}};
    double sum = 0., variance = 0.;
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
      const Estimate radiance = sums.estimate(pixel * bands + band);
      result.radiance.values.insert(result.radiance.values.end(), {static_cast<float>(radiance.value), 0.f});
      result.standard_error.values.push_back(static_cast<float>(radiance.standard_error));
      sum += radiance.value;
      variance += std::pow(radiance.standard_error, 2);
    }
    const auto count = static_cast<double>(pixels);
    result.mean = {sum / count, std::sqrt(variance) / count};
    result.paths = sums.units() * parts_->paths_per_unit;
  }
  return results;
}

std::vector<CameraResult> together(std::vector<CameraResult> once, const std::vector<CameraResult>& more) {
  const auto add = [](Estimate& to, const Estimate& other) {
    to = {to.value + other.value, std::hypot(to.standard_error, other.standard_error)};
  };
  for (std::size_t band = 0; band < once.size(); ++band) {
    CameraResult& sum = once[band];
    const CameraResult& other = more[band];
    for (std::size_t i = 0; i < sum.radiance.values.size(); ++i) sum.radiance.values[i] += other.radiance.values[i];
    for (std::size_t i = 0; i < sum.standard_error.values.size(); ++i)
      sum.standard_error.values[i] = std::hypot(sum.standard_error.values[i], other.standard_error.values[i]);
    add(sum.mean, other.mean);
    sum.paths += other.paths;
  }
  return once;
}

double LightPictureJob::relativeError(const TraceSums& sums, const std::vector<double>& once) const {
  double largest = 0.;
  const std::vector<CameraResult> pictures = results(sums);
  for (std::size_t band = 0; band < pictures.size(); ++band) {
    const Estimate& mean = pictures[band].mean;
    const double whole = mean.value + once[band];
    if (whole > 0.)
      largest = std::max(largest, mean.standard_error * std::sqrt(static_cast<double>(parts_->pixels())) / whole);
  }
  return largest;
}

}  // namespace sunfleck
