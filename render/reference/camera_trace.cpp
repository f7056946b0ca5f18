#include "render/reference/camera_trace.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.hpp"
#include "core/require.hpp"
#include "render/reference/detail/absorption.hpp"
#include "render/reference/detail/batch_mean.hpp"
#include "render/reference/detail/cosine_law.hpp"
#include "render/reference/detail/ordered_batches.hpp"
#include "render/reference/detail/scene_geometry.hpp"
#include "render/reference/detail/stopwatch.hpp"

namespace sunfleck {
using namespace detail;
namespace {

constexpr int kStrata = 2;                          // per side of a pixel
constexpr int kSamplesPerPass = kStrata * kStrata;  // per pixel
constexpr int kRowsPerBlock = 8;                    // traced by one thread at a time
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Sums over the samples of a pixel.
struct PixelSum {
  double radiance = 0., squares = 0.;
};

class EyePaths {
 public:
  EyePaths(const RayScene::Geometry& scene, const TraceLight& light, const PixelRays& rays, float ground_height)
      : scene_(scene), light_(light), rays_(rays), to_sun_(-light.sun), ground_(ground_height - scene.origin.z) {
    rays_.corner -= scene.origin;
    reach_ = 0.5f * glm::length(scene.box.size()) + 8.f * scene.lift;
  }

  // Adds one sample of every stratum to each pixel of rows first .. last - 1.
  void addPass(int first, int last, Random random, std::vector<PixelSum>& sums) const {
    for (int y = first; y < last; ++y)
      for (int x = 0; x < rays_.width; ++x) {
        PixelSum& sum =
            sums[static_cast<std::size_t>(y) * static_cast<std::size_t>(rays_.width) + static_cast<std::size_t>(x)];
        for (int stratum = 0; stratum < kSamplesPerPass; ++stratum) {
          const float right = (static_cast<float>(stratum % kStrata) + random.uniform()) / kStrata;
          const float down = (static_cast<float>(stratum / kStrata) + random.uniform()) / kStrata;
          const double radiance = sample(rays_.corner + (static_cast<float>(x) + right) * rays_.right_step +
                                             (static_cast<float>(y) + down) * rays_.down_step,
                                         random);
          sum.radiance += radiance;
          sum.squares += radiance * radiance;
        }
      }
  }

 private:
  // Radiance that arrives along the line of sight through a point [1/sr].
  double sample(const glm::vec3& on_line, Random& random) const {
    glm::vec3 from = startOf(on_line);
    glm::vec3 direction = rays_.sight;
    double weight = 1., radiance = 0., absorbed = 0.;
    for (int scatterings = 0; scatterings < kMostScatterings; ++scatterings) {
      const float to_ground = toGround(from, direction);
      Hit hit =
          scene_.closest(from, direction, scatterings == 0 ? Coherence::coherent : Coherence::incoherent, to_ground);
      if (hit.surface == Surface::none) {
        if (to_ground == kInfinity) break;
        hit.position = from + to_ground * direction;
        hit.position.z = ground_;
        hit.normal = {0.f, 0.f, 1.f};
      }
      const Shares shares = sharesOf(hit);
      radiance += weight * fromSun(hit, shares);
      const float albedo = shares.reflected + shares.passed;
      if (!scatters(double{albedo}, weight, absorbed, random)) break;
      const glm::vec3 side = random.uniform() * albedo < shares.reflected ? hit.normal : -hit.normal;
      from = scene_.leave(hit.position, side);
      direction = lambertDirection(side, random);
    }
    return radiance;
  }

  // Where a line of sight starts: right before the box, where positions are exact, but before it meets the ground and,
  // where a layer of trees has no end, before that.
  glm::vec3 startOf(const glm::vec3& on_line) const {
    const Direction& sight = rays_.sight;
    const glm::vec3 from = on_line - (glm::dot(on_line - scene_.box.centre(), sight) + reach_) * sight;
    if (sight.z == 0.f || (!scene_.period && light_.ground_albedo == 0.f)) return from;
    const float face = sight.z > 0.f ? scene_.low : std::max(scene_.high, ground_);
    return from + std::min(0.f, (face - from.z) / sight.z) * sight;
  }

  struct Shares {
    float reflected, passed;  // of the arriving light [1]
  };
  Shares sharesOf(const Hit& hit) const {
    if (hit.surface == Surface::none) return {light_.ground_albedo, 0.f};
    const TreeOptics tree = light_.ofKind(hit.kind);
    if (hit.surface == Surface::wood) return {tree.wood_reflectance, 0.f};
    return {tree.leaf.reflectance, tree.leaf.transmittance};
  }

  // Distance to the ground along a ray, infinite if it meets none.
  float toGround(const glm::vec3& from, const glm::vec3& direction) const {
    if (light_.ground_albedo == 0.f || direction.z >= 0.f || from.z < ground_) return kInfinity;
    return (ground_ - from.z) / direction.z;
  }

  // Radiance that a surface sends on from the sun to the side its normal points to [1/sr].
  double fromSun(const Hit& hit, const Shares& shares) const {
    const float cosine = glm::dot(hit.normal, to_sun_);
    const float share = cosine > 0.f ? shares.reflected : shares.passed;
    if (share == 0.f || cosine == 0.f) return 0.;
    const glm::vec3 from = scene_.leave(hit.position, cosine > 0.f ? hit.normal : -hit.normal);
    if (scene_.blocked(from, to_sun_)) return 0.;
    return double{share} * std::abs(double{cosine}) * std::numbers::inv_pi;
  }

  const RayScene::Geometry& scene_;
  const TraceLight& light_;
  PixelRays rays_;
  Direction to_sun_;
  float ground_;       // height [m]
  float reach_ = 0.f;  // from the box's centre to where rays start [m]
};

void validate(const PixelRays& rays) {
  require(rays.width > 0 && rays.width <= 65536, "picture width", rays.width, "from 1 to 65536");
  require(rays.height > 0 && rays.height <= 65536, "picture height", rays.height, "from 1 to 65536");
  const double length = glm::length(glm::dvec3(rays.sight));
  require(std::abs(length - 1.) < 1e-4, "length of the direction of sight", length, "1");
  for (const glm::vec3& v : {rays.corner, rays.right_step, rays.down_step})
    for (int axis = 0; axis < 3; ++axis)
      require(std::abs(v[axis]) <= 1e7f, "corner or step of the picture's pixels", v[axis], "finite and at most 1e7 m");
}

Image emptyImage(const PixelRays& rays) {
  Image image{.width = rays.width, .height = rays.height, .channels = {"Y"}, .values = {}};
  image.values.reserve(static_cast<std::size_t>(rays.width) * static_cast<std::size_t>(rays.height));
  return image;
}

CameraResult resultOf(const std::vector<PixelSum>& sums, const PixelRays& rays, std::uint64_t passes) {
  CameraResult result;
  result.radiance = emptyImage(rays);
  result.standard_error = emptyImage(rays);
  const double samples = static_cast<double>(passes) * kSamplesPerPass;
  double sum = 0., variance_sum = 0.;
  for (const PixelSum& pixel : sums) {
    const double mean = pixel.radiance / samples;
    const double variance = std::max(0., pixel.squares / samples - mean * mean) / (samples - 1.);  // of the mean
    result.radiance.values.push_back(static_cast<float>(mean));
    result.standard_error.values.push_back(static_cast<float>(std::sqrt(variance)));
    sum += mean;
    variance_sum += variance;
  }
  const double pixels = static_cast<double>(sums.size());
  result.mean = {.value = sum / pixels, .standard_error = std::sqrt(variance_sum) / pixels};
  result.paths = sums.size() * passes * kSamplesPerPass;
  return result;
}

}  // namespace

CameraResult traceCamera(const RayScene& scene, const TraceLight& light, const PixelRays& rays, float ground_height,
                         const TraceEffort& effort, const Progress& progress) {
  requireFitting(light, scene);
  validate(effort);
  validate(rays);
  require(std::isfinite(ground_height), "ground height", ground_height, "finite");
  const RayScene::Geometry& geometry = scene.geometry();
  if (geometry.period && light.ground_albedo > 0.f)
    require(ground_height <= geometry.stand_box.low.z, "ground height", ground_height,
            "at most the bottom of a periodic stand, " + std::to_string(geometry.stand_box.low.z));

  const Stopwatch stopwatch;
  const EyePaths paths(geometry, light, rays, ground_height);
  const std::size_t pixels = static_cast<std::size_t>(rays.width) * static_cast<std::size_t>(rays.height);
  const std::uint64_t per_pass = pixels * kSamplesPerPass;
  const std::uint64_t passes = (effort.paths + per_pass - 1) / per_pass;
  const auto blocks = static_cast<std::size_t>((rays.height + kRowsPerBlock - 1) / kRowsPerBlock);
  std::vector<PixelSum> sums(pixels);
  std::uint64_t done = 0;
  bool go_on = true;
  while (done < passes && go_on) {
    inOrder(
        blocks, effort.threads,
        [&](std::size_t block, const Stopped&) {
          const int first = static_cast<int>(block) * kRowsPerBlock;
          paths.addPass(first, std::min(first + kRowsPerBlock, rays.height), Random(effort.seed, done * blocks + block),
                        sums);
          return block;
        },
        [&](std::size_t block, std::size_t) {
          const double part = static_cast<double>(block + 1) / static_cast<double>(blocks);
          go_on = goOn(progress, (static_cast<double>(done) + part) / static_cast<double>(passes)) && go_on;
          return true;
        });
    ++done;
  }
  CameraResult result = resultOf(sums, rays, done);
  result.seconds = stopwatch.seconds();
  result.cpu_seconds = stopwatch.cpuSeconds();
  return result;
}

}  // namespace sunfleck
