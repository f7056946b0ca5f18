#include "render/compare/reference_picture.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "core/require.hpp"
#include "render/compare/pixel_rays.hpp"
#include "render/compare/scene_media.hpp"
#include "render/compare/validation.hpp"
#include "render/reference/camera_trace.hpp"
#include "render/reference/trace_sums.hpp"

namespace sunfleck {
namespace {

constexpr int kSamplesPerUnit = 4;  // few, so that the whole picture is there soon
constexpr std::uint64_t kMostUnits = 1u << 14;
constexpr double kFirstTarget = 0.5;
// Each stage brings the noise down by this factor, by twice the work.
constexpr double kStage = 0.7;

// Tracing must not hold up what people wait for. Linux has a priority for each thread.
void lowerPriority() {
  setpriority(PRIO_PROCESS, 0, std::min(19, getpriority(PRIO_PROCESS, 0) + 10));
}

}  // namespace

namespace {

// Adds the light of one sun to the picture; errors add by their squares.
void addPart(ReferencePicture::Snapshot& shot, const std::vector<int>& bands,
             const std::vector<CameraResult>& results) {
  for (std::size_t of = 0; of < bands.size(); ++of) {
    const auto band = static_cast<std::size_t>(bands[of]);
    const std::vector<float>&radiance = results[of].radiance.values, &error = results[of].standard_error.values;
    for (std::size_t pixel = 0; pixel < error.size(); ++pixel) {
      const std::size_t i = pixel * kBands + band;
      shot.radiance.values[i] += radiance[2 * pixel];
      shot.standard_error.values[i] = std::hypot(shot.standard_error.values[i], error[pixel]);
    }
  }
}

// Rays are traced through trees that stand.
Scene withoutKindsThatStandNowhere(Scene scene) {
  constexpr std::uint32_t kNowhere = ~0u;
  std::vector<std::uint32_t> number(scene.kinds.size(), kNowhere);
  std::vector<TreeKind> standing;
  for (Placement& tree : scene.stand.trees) {
    std::uint32_t& of = number[tree.kind];
    if (of == kNowhere) {
      of = static_cast<std::uint32_t>(standing.size());
      standing.push_back(scene.kinds[tree.kind]);
    }
    tree.kind = of;
  }
  if (!standing.empty()) scene.kinds = std::move(standing);
  return scene;
}

}  // namespace

// What rays are traced through, kept for the next run where only camera, light or optics change.
struct ReferencePicture::Traced {
  explicit Traced(const Scene& scene)
      : kinds(scene.kinds), stand(scene.stand), rays(meshes(scene), scene.stand, true, traceMedia(scene)) {}

  bool fits(const Scene& scene) const {
    const auto same_mesh = [](const TreeKind& a, const TreeKind& b) { return a.mesh == b.mesh; };
    return scene.media.empty() && stand == scene.stand && std::ranges::equal(kinds, scene.kinds, same_mesh);
  }

  std::vector<TreeKind> kinds;
  Stand stand;
  RayScene rays;
};

struct ReferencePicture::Run {
  // The light of one sun, or of the sky.
  struct Part {
    Part(const RayScene& rays, std::vector<int> of_bands, const std::vector<TraceLight>& lights, const Scene& scene)
        : bands(std::move(of_bands)),
          job(rays, lights, pixelRays(scene), bounds(scene).low.z, kSamplesPerUnit),
          sums(job.bins(), job.groups()),
          results(job.results(sums)) {}
    std::vector<int> bands;  // those with light
    CameraJob job;
    TraceSums sums;
    std::vector<CameraResult> results;  // of each of them, up to date with the sums in each pixel
  };

  Run(const Scene& of_scene, double noise) : scene(of_scene), target(noise) {}
  void traceUnits(Part& part, const std::vector<std::uint64_t>& units, std::uint64_t seed, int threads);

  Scene scene;
  double target;  // of the noise
  Stopped stopped = false;
  mutable std::mutex mutex;  // of all that follows
  Image black;               // of the picture's size; without pixels before tracing begins
  std::vector<std::unique_ptr<Part>> parts;
  std::uint64_t paths = 0;
  bool running = true, finished = false;
  std::string failure;
};

// Side by side. Nobody else changes the sums meanwhile.
void ReferencePicture::Run::traceUnits(Part& part, const std::vector<std::uint64_t>& units, std::uint64_t seed,
                                       int threads) {
  std::atomic<std::size_t> next = 0;
  std::exception_ptr thrown;
  const auto work = [&] {
    lowerPriority();
    try {
      UnitTally tally(part.job.bins());
      for (std::size_t i = next++; i < units.size() && !stopped; i = next++, tally.clear()) {
        part.job.trace(seed, units[i], tally, stopped);
        const std::scoped_lock lock(mutex);
        if (stopped) return;
        part.sums.add(seed, units[i], tally);
        part.job.refresh(part.results, part.sums, units[i] % part.job.groups());
        paths += part.job.pathsOf(units[i]);
      }
    } catch (...) {
      const std::scoped_lock lock(mutex);
      thrown = std::current_exception();
      next = units.size();
    }
  };
  std::vector<std::thread> workers;
  for (int i = 0; i < threads; ++i) workers.emplace_back(work);
  for (std::thread& worker : workers) worker.join();
  if (thrown) std::rethrow_exception(thrown);
}

struct ReferencePicture::Thread {
  std::thread thread;
};

ReferencePicture::ReferencePicture(int threads, std::uint64_t seed)
    : threads_(threads), seed_(seed), thread_(std::make_unique<Thread>()) {
  require(threads >= 1 && threads <= 1024, "threads", threads, "from 1 to 1024");
}

ReferencePicture::~ReferencePicture() {
  cancel();
  if (thread_->thread.joinable()) thread_->thread.join();
}

void ReferencePicture::start(const Scene& scene, double target) {
  require(target > 0., "target", target, "above 0");
  cancel();
  run_ = std::make_shared<Run>(withoutKindsThatStandNowhere(scene), target);
  // The next waits for the last, so that none of this waits.
  thread_->thread = std::thread([this, run = run_, last = std::move(thread_->thread)]() mutable {
    if (last.joinable()) last.join();
    work(*run);
  });
}

void ReferencePicture::cancel() {
  if (run_) run_->stopped = true;
}

void ReferencePicture::work(Run& run) {
  std::string failure;
  try {
    trace(run);
  } catch (const std::exception& e) {
    failure = e.what();
  }
  const std::scoped_lock lock(run.mutex);
  run.running = false;
  run.failure = failure;
}

void ReferencePicture::trace(Run& run) {
  if (run.stopped) return;
  if (run.scene.stand.trees.empty()) throw InvalidInput("Monte Carlo needs a tree: none stands");
  if (!traced_ || !traced_->fits(run.scene)) {
    traced_.reset();
    traced_ = std::make_shared<const Traced>(run.scene);
  }
  std::vector<std::unique_ptr<Run::Part>> made;
  for (const std::vector<TraceLight>& lights : traceLightsOfSuns(run.scene, {0, 1, 2})) {
    std::vector<int> bands;
    std::vector<TraceLight> lit;
    for (const TraceLight& light : lights)
      if (light.sun_irradiance > 0.f || (light.sky && light.sky->irradiance()[light.sky_band] > 0.)) {
        bands.push_back(light.sky_band);
        lit.push_back(light);
      }
    if (!lit.empty()) made.push_back(std::make_unique<Run::Part>(traced_->rays, bands, lit, run.scene));
  }
  const PixelRays rays = pixelRays(run.scene);
  Image black{.width = rays.width, .height = rays.height, .channels = {"R", "G", "B"}, .values = {}};
  black.values.resize(black.at(0, rays.height, 0));
  {
    const std::scoped_lock lock(run.mutex);
    run.black = std::move(black);
    run.parts = std::move(made);
  }
  for (double target = std::max(kFirstTarget, run.target); !run.stopped;) {
    bool there = true;
    for (const std::unique_ptr<Run::Part>& part : run.parts) {
      std::vector<std::uint64_t> units;
      for (const auto& [first, last] : part->job.unitsFor(target, kMostUnits, part->sums, seed_).ranges())
        for (std::uint64_t unit = first; unit < last; ++unit) units.push_back(unit);
      if (units.empty() || run.stopped) continue;
      there = false;
      run.traceUnits(*part, units, seed_, threads_);
    }
    if (!there) continue;
    if (target == run.target) break;
    target = std::max(kStage * target, run.target);
  }
  const std::scoped_lock lock(run.mutex);
  run.finished = !run.stopped;
}

ReferencePicture::Snapshot ReferencePicture::snapshot() const {
  Snapshot shot{.noise = std::numeric_limits<double>::infinity()};
  if (!run_) return shot;
  {
    const std::scoped_lock lock(run_->mutex);
    shot.paths = run_->paths;
    shot.running = run_->running;
    shot.finished = run_->finished;
    shot.failure = run_->failure;
    shot.radiance = shot.standard_error = run_->black;
    for (const std::unique_ptr<Run::Part>& part : run_->parts) addPart(shot, part->bands, part->results);
  }
  const std::vector<float>&errors = shot.standard_error.values, &radiances = shot.radiance.values;
  if (shot.finished) shot.noise = 0.;  // where there is no light at all
  if (shot.paths == 0) return shot;
  const auto pixels = static_cast<double>(errors.size()) / kBands;
  shot.samples = static_cast<double>(shot.paths) / pixels;
  shot.noise = 0.;
  for (std::size_t band = 0; band < kBands; ++band) {
    double squares = 0., sum = 0.;
    for (std::size_t i = band; i < errors.size(); i += kBands) {
      squares += double{errors[i]} * double{errors[i]};
      sum += double{radiances[i]};
    }
    if (sum > 0.) shot.noise = std::max(shot.noise, std::sqrt(squares * pixels) / sum);
  }
  return shot;
}

}  // namespace sunfleck
