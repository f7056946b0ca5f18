#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "apps/brf_output.hpp"
#include "apps/cell_output.hpp"
#include "apps/commands.hpp"
#include "apps/run_identity.hpp"
#include "apps/spectrum.hpp"
#include "apps/team.hpp"
#include "apps/terminal.hpp"
#include "apps/trace_options.hpp"
#include "apps/trace_output.hpp"
#include "apps/version.hpp"
#include "core/elapsed.hpp"
#include "core/require.hpp"
#include "core/whole_file.hpp"
#include "grid/density_grid.hpp"
#include "render/compare/pixel_rays.hpp"
#include "render/compare/scene_media.hpp"
#include "render/compare/validation.hpp"
#include "render/image_file.hpp"
#include "render/reference/brf_trace.hpp"
#include "render/reference/camera_trace.hpp"
#include "render/reference/forward_trace.hpp"
#include "render/reference/light_picture.hpp"
#include "render/reference/team_run.hpp"
#include "render/reference/trace_goal.hpp"
#include "render/scene_images.hpp"

namespace sunfleck::apps {
namespace {

constexpr double kPaths = 4e6;
// A run that is to reach an error stops here at the latest.
constexpr double kMostPaths = 1e15;
// Of a picture by light: paths of light for each sample of a pixel, and the share of the error left to what was
// scattered once. By these both took what they are worth of the time, for a crown of albedo 0.95.
constexpr double kLightPaths = 0.5, kErrorOnce = 0.4;
// And of the time that is left, of which the rest is for the light scattered more often.
constexpr double kTimeOnce = 0.2;
constexpr std::uint64_t kMostUnits = 1'000'000;  // of each tile or view

const std::array<std::string, kBands> kBandNames{"red", "green", "blue"};

class TraceRun {
 public:
  TraceRun(const TraceOptions& options, const RunOptions& run, const Scene& scene)
      : options_(options),
        run_(run),
        scene_(scene),
        extent_(extentOf(options)),
        rays_(meshes(scene), scene.stand, !options.without_wood, traceMedia(scene)) {
    if (!options.other_leaf.empty()) traced_leaf_ = leafOfAll(scene, options);
    if (!options.spectrum.empty()) {
      Spectrum spectrum = readSpectrum(options.spectrum, scene, options.band);
      bands_ = std::move(spectrum.bands);
      names_ = std::move(spectrum.names);
    } else {
      bands_ = traceLights(scene, options.all_bands ? std::vector{0, 1, 2} : std::vector{options.band});
      if (options.all_bands) names_.assign(kBandNames.begin(), kBandNames.end());
    }
    if (run.team) requireSameAtAll(*run.team, runIdentity(scene, !options.without_wood));
    if (!options.checkpoint.empty() && !(run.team && run.team->rank() > 0))
      store_ = TraceStore(options.checkpoint, options.write_every, runIdentity(scene, !options.without_wood));
  }

  void light() {
    std::vector<ForwardResult> results;
    std::vector<CellBand> cells;
    std::optional<TraceCells> grid;
    Spent spent;
    // As many bands as one path carries, then the others on paths of the same random numbers.
    for (std::size_t first = 0; first < bands_.size() && !interruptedAnywhere(run_.team); first += kMostBands) {
      const std::vector<TraceLight> bands(
          bands_.begin() + static_cast<std::ptrdiff_t>(first),
          bands_.begin() + static_cast<std::ptrdiff_t>(std::min(bands_.size(), first + kMostBands)));
      const std::string name = first == 0 ? "light" : fmt::format("light {}", 1 + first / kMostBands);
      const auto paths = static_cast<std::uint64_t>(options_.paths.value_or(extent_.target > 0. ? kMostPaths : kPaths));
      const std::uint64_t per_unit = unitSize(name, "paths per unit", pathsPerUnit(paths));
      if (!options_.cells.empty()) grid.emplace(rays_, options_.cell, bands.size());
      // A file may be asked for its leaves later.
      const bool leaves = !options_.leaves.empty() || !options_.checkpoint.empty();
      const ForwardJob job(rays_, bands, per_unit, {.leaves = leaves, .cells = grid});
      TraceSection& section = store_.section(name, job);
      const std::uint64_t units = unitsOf(paths, per_unit);
      section.asked = extent_.target == 0. ? units : 0;
      const TraceGoal goal = extent_.target > 0.
                                 ? until(
                                       extent_.target, [&](const auto& sums) { return job.relativeError(sums); }, units)
                                 : allOf(partOf(units, extent_.part.number, extent_.part.of));
      spent.add(work(goal, job, section, "tracing light"));
      if (section.sums.units() == 0) continue;
      if (extent_.target > 0.)
        tellTarget(section.sums.units() >= kLeastUnits && job.relativeError(section.sums) <= extent_.target);
      for (ForwardResult& result : job.results(section.sums)) results.push_back(std::move(result));
      for (std::size_t band = 0; grid && band < bands.size(); ++band)
        cells.push_back({names_.empty() ? "" : names_[first + band], job.cells(section.sums, band),
                         job.incidentFlux(static_cast<int>(band))});
    }
    if (results.empty()) return;

    const ForwardResult& first = results.front();
    if (!options_.leaves.empty()) writeLeaves(options_.leaves, scene_, first);
    if (grid)
      writeCells(options_.cells, *grid, cells,
                 {sourceOf(scene_), standHash(meshes(scene_), scene_.stand), versionText()});
    if (!options_.spectrum_out.empty()) writeSpectrum(options_.spectrum_out, names_, results);
    figures_ = figuresOf(first);
    json_.update(jsonOf(first));
    json_["paths"] = first.paths;
    json_["seconds"] = spent.seconds;
    json_["cpu_seconds"] = spent.cpu_seconds;
    for (std::size_t band = 0; band < results.size() && !names_.empty(); ++band) {
      nlohmann::ordered_json of_band{{"name", names_[band]}};
      of_band.update(jsonOf(results[band]));
      json_["bands"].push_back(of_band);
    }
    if (!run_.json) {
      fmt::print("{}: share of the incident light\n", scene_.name);
      for (std::size_t band = 0; band < results.size(); ++band) {
        if (!names_.empty()) fmt::print(" {}\n", names_[band]);
        fmt::print("{}", tableOf(results[band]));
      }
      printSpeed(first.paths, spent);
    }
    if (!options_.other_leaf.empty()) printOtherLeaf(first);
  }

  void picture() {
    const PixelRays pixels = pixelRays(scene_);
    const auto samples = static_cast<std::uint64_t>(options_.samples);
    // A run against the clock goes by small units, so that it gets through all tiles early.
    constexpr std::uint64_t kSamplesAgainstTheClock = 16;
    const bool timed = std::isfinite(extent_.seconds);
    const std::uint64_t per_unit = unitSize(
        "picture", "samples per unit",
        static_cast<std::uint64_t>(samplesPerUnit(timed ? std::min(samples, kSamplesAgainstTheClock) : samples)));
    // What was scattered once has little noise by paths from the camera and costs little; the rest may be had by light.
    const bool by_light = !options_.by_eye && LightPictureJob::suits(rays_, bands_, pixels);
    const CameraJob job(rays_, bands_, pixels, bounds(scene_).low.z, static_cast<int>(per_unit),
                        by_light ? Followed::once : Followed::all);
    TraceSection& section = store_.section("picture", job);
    Spent spent = workOnGroups(job, job.unitsOf(samples), section, "tracing the picture",
                               by_light ? kErrorOnce * extent_.target : extent_.target, by_light ? kTimeOnce : 1.);
    std::vector<CameraResult> results = job.results(section.sums);
    if (by_light) {
      const std::vector<CameraResult> more = lightPicture(pixels, samples, results, spent);
      if (run_.team && run_.team->rank() > 0) return;
      if (more.front().paths == 0 || !coversAll(section.sums)) {
        fmt::print(stderr, "sunfleck: no picture: ended before all kinds of its light had been traced\n");
        return;
      }
      results = together(std::move(results), more);
    }
    if (section.sums.units() == 0) return;
    const CameraResult& result = results.front();
    if (!options_.picture.empty())
      writeImage(options_.picture, options_.all_bands ? colours(results) : result.radiance, options_.display.display());
    json_["image_mean"] = result.mean.value;
    json_["image_mean_se"] = result.mean.standard_error;
    json_["image_paths"] = result.paths;
    json_["image_cpu_seconds"] = spent.cpu_seconds;
    if (run_.json) return;
    fmt::print("picture {} x {}: mean radiance {:.7f} +- {:.7f}\n", pixels.width, pixels.height, result.mean.value,
               result.mean.standard_error);
    printSpeed(result.paths, spent);
  }

  void brf(const std::vector<BrfView>& views) {
    std::vector<ViewDirection> directions;
    for (const BrfView& view : views) directions.push_back(view.direction);
    const auto paths = static_cast<std::uint64_t>(options_.brf.paths);
    const std::uint64_t per_unit = unitSize("brf", "paths per unit", pathsPerUnit(paths));
    const BrfJob job(rays_, bands_, directions, per_unit);
    TraceSection& section = store_.section("brf", job);
    const Spent spent = workOnGroups(job, job.unitsOf(paths), section, "tracing reflectance factors", extent_.target);
    if (section.sums.units() == 0) return;

    const std::vector<BrfResult> results = job.results(section.sums);
    const BrfResult& first = results.front();
    for (std::size_t i = 0; i < views.size(); ++i) figures_.push_back({views[i].name, first.views[i].whole});
    figures_.push_back({"brf_albedo", first.albedo.whole});
    if (!options_.brf.csv.empty()) writeBrf(options_.brf.csv, views, results, {kBandNames.begin(), kBandNames.end()});
    if (!options_.brf.mes.empty()) writeMes(options_.brf.mes, views, first, scene_);
    json_["brf"] = jsonOf(views, first);
    json_["brf_albedo"] = jsonOf(first.albedo, "albedo");
    json_["brf_paths"] = first.paths;
    json_["brf_cpu_seconds"] = spent.cpu_seconds;
    if (options_.all_bands)
      for (const BrfResult& result : results)
        json_["brf_bands"].push_back({{"brf", jsonOf(views, result)}, {"albedo", jsonOf(result.albedo, "albedo")}});
    if (run_.json) return;
    const bool one_direction = scene_.sky.kind == SceneSky::Kind::none && scene_.sun().diameter == 0.f;
    fmt::print("{}, sun at {:.6g} degrees\n",
               one_direction ? "reflectance factors" : "hemispherical-directional reflectance factors (HDRF)",
               double{scene_.sun().zenith} * 180. / std::numbers::pi);
    for (std::size_t band = 0; band < results.size(); ++band) {
      if (options_.all_bands) fmt::print(" {}\n", kBandNames[band]);
      fmt::print("{}", tableOf(views, results[band], one_direction ? "BRF" : "HDRF"));
    }
    printSpeed(first.paths, spent);
  }

  // Holds against what others found what has been traced of it.
  void compare(std::vector<NamedEstimate> reference) {
    std::erase_if(reference, [&](const NamedEstimate& row) {
      return std::none_of(figures_.begin(), figures_.end(), [&](const auto& of) { return of.name == row.name; });
    });
    json_["comparison"] = comparisonJson(figures_, reference);
    if (!run_.json) fmt::print("against {}\n{}", options_.compare, comparisonTable(figures_, reference));
  }

  const nlohmann::ordered_json& json() const { return json_; }
  const std::string& failure() const { return store_.failure(); }  // of the last write of the checkpoint

 private:
  struct Spent {
    std::uint64_t units = 0, units_before = 0;
    double seconds = 0., cpu_seconds = 0.;

    void add(const Spent& more) {
      units += more.units;
      units_before += more.units_before;
      seconds += more.seconds;
      cpu_seconds += more.cpu_seconds;
    }
  };

  // What light scattered more than once adds to the picture `once`.
  std::vector<CameraResult> lightPicture(const PixelRays& pixels, std::uint64_t samples,
                                         const std::vector<CameraResult>& once, Spent& spent) {
    const double paths = kLightPaths * static_cast<double>(samples) * static_cast<double>(pixels.width) *
                         static_cast<double>(pixels.height);
    const auto count = static_cast<std::uint64_t>(extent_.target > 0. ? kMostPaths : std::max(paths, 64.));
    const std::uint64_t per_unit = unitSize("picture by light", "paths per unit", pathsPerUnit(count));
    const LightPictureJob job(rays_, bands_, pixels, per_unit);
    TraceSection& section = store_.section("picture by light", job);
    const std::uint64_t units = unitsOf(count, per_unit);
    section.asked = extent_.target == 0. ? units : 0;
    std::vector<double> means;
    for (const CameraResult& band : once) means.push_back(band.mean.value);
    const double target = std::sqrt(1. - kErrorOnce * kErrorOnce) * extent_.target;
    const auto error = [&](const TraceSums& sums) { return job.relativeError(sums, means); };
    const TraceGoal goal =
        target > 0. ? until(target, error, units) : allOf(partOf(units, extent_.part.number, extent_.part.of));
    spent.add(work(goal, job, section, "tracing light to the camera"));
    if (target > 0. && section.sums.units() > 0)
      tellTarget(section.sums.units() >= kLeastUnits && error(section.sums) <= target);
    return job.results(section.sums);
  }

  // A size of a unit that a run began with is kept, whatever it is told on going on. Rank 0 knows.
  std::uint64_t unitSize(const std::string& section, const std::string& name, std::uint64_t fresh) {
    const TraceIdentity* begun = store_.identity(section);
    std::string text = begun && begun->contains(name) ? begun->at(name) : std::to_string(fresh);
    if (run_.team) text = run_.team->fromFirst(std::move(text));
    std::from_chars(text.data(), text.data() + text.size(), fresh);
    return fresh;
  }

  // Whether every tile has been traced.
  static bool coversAll(const TraceSums& sums) {
    for (std::uint64_t group = 0; group < sums.groups(); ++group)
      if (sums.units(group) == 0) return false;
    return true;
  }

  //   time  share of what is left of it
  Spent work(const TraceGoal& goal, const TraceJob& job, TraceSection& section, const std::string& label,
             double time = 1.) {
    Spent spent{.units_before = section.sums.units()};
    TraceGoal timed = goal;
    timed.seconds = time * (extent_.seconds - begun_.seconds());
    const Elapsed elapsed;
    if (!pursue(timed, job, section, store_, run_.seed, run_.threads, terminalProgress(label, run_.quiet), run_.team) &&
        !interruptedAnywhere(run_.team))
      fmt::print(stderr, "sunfleck: {}: ended by --time before all was done\n", label);
    spent.seconds = elapsed.seconds();
    spent.cpu_seconds = sumOverRanks(run_.team, elapsed.cpuSeconds());
    spent.units = section.sums.units();
    return spent;
  }

  // The same for a job whose tiles or views take as many units as their own noise asks for: `units` in all, or what
  // brings it to the target.
  template <typename Job>
  Spent workOnGroups(const Job& job, std::uint64_t units, TraceSection& section, const std::string& label,
                     double target, double time = 1.) {
    if (target == 0.) {
      section.asked = units;
      return work(allOf(partOf(units, extent_.part.number, extent_.part.of)), job, section, label, time);
    }
    section.asked = 0;
    const TraceGoal goal{
        .next = [&](const TraceSums& sums, std::uint64_t seed) { return job.unitsFor(target, kMostUnits, sums, seed); },
        .name = fmt::format("error {}", target)};
    const Spent spent = work(goal, job, section, label, time);
    tellTarget(job.reached(target, section.sums));
    return spent;
  }

  // Speed tells of the paths of this time alone.
  static void printSpeed(std::uint64_t paths, const Spent& spent) {
    const double share = 1. - static_cast<double>(spent.units_before) / static_cast<double>(spent.units);
    const double now = share * static_cast<double>(paths);
    fmt::print("  {} paths", paths);
    if (spent.units_before > 0) fmt::print(", {:.0f} of them now,", now);
    fmt::print(" in {:.1f} s, {:.2f} million per CPU second\n", spent.seconds, now * 1e-6 / spent.cpu_seconds);
  }

  // The leaf that all kinds have in the band traced.
  static LeafOptics leafOfAll(const Scene& scene, const TraceOptions& options) {
    const auto band = static_cast<std::size_t>(options.band);
    const LeafOptics traced = scene.kinds.front().leaf[band];
    for (const TreeKind& kind : scene.kinds)
      if (kind.leaf[band] != traced || kind.maps)
        throw InvalidInput("--other-leaf: must be for scenes whose leaves are all alike in the band");
    if (traced.gloss > 0.f) throw InvalidInput("--other-leaf: must be for scenes whose leaves have no gloss");
    for (const SceneMedium& medium : scene.media)
      if (medium.particles || medium.optics[band] != traced)
        throw InvalidInput(
            "--other-leaf: must be for scenes whose leaves are all alike in the band, without particles");
    OrderTable().reweighted(traced, {.reflectance = options.other_leaf[0], .transmittance = options.other_leaf[1]});
    return traced;
  }

  void tellTarget(bool reached) {
    json_["target_reached"] = reached && json_.value("target_reached", true);
    if (!reached) fmt::print(stderr, "sunfleck: the target of {} is not reached\n", options_.target);
  }

  // Of three bands, red, green and blue.
  static Image colours(const std::vector<CameraResult>& bands) {
    const Image& first = bands.front().radiance;
    Image image{.width = first.width, .height = first.height, .channels = {"R", "G", "B"}, .values = {}};
    for (std::size_t i = 0; i < first.values.size(); i += first.channels.size())
      for (const CameraResult& band : bands) image.values.push_back(band.radiance.values[i]);
    return image;
  }

  void printOtherLeaf(const ForwardResult& result) {
    const LeafOptics leaf{.reflectance = options_.other_leaf[0], .transmittance = options_.other_leaf[1]};
    const LeafOptics traced = *traced_leaf_;
    const Estimate up = result.reflected_by_order.reweighted(traced, leaf);
    const Estimate down = result.arriving_ground_by_order.reweighted(traced, leaf);
    json_["other_leaf"] = {
        {"reflectance", leaf.reflectance},
        {"transmittance", leaf.transmittance},
        {"reflected", up.value},
        {"arriving_ground", down.value},
        {"standard_errors", {{"reflected", up.standard_error}, {"arriving_ground", down.standard_error}}}};
    if (!run_.json) fmt::print("{}", tableOf(result, traced, leaf));
  }

  const TraceOptions& options_;
  const RunOptions& run_;
  const Scene& scene_;
  Extent extent_;
  RayScene rays_;
  std::vector<TraceLight> bands_;
  std::vector<std::string> names_;  // of the bands; none where there is one that was not named
  TraceStore store_;
  std::vector<NamedEstimate> figures_;  // of the first band
  nlohmann::ordered_json json_ = nlohmann::ordered_json::object();
  std::optional<LeafOptics> traced_leaf_;  // where --other-leaf asks for others
  Elapsed begun_;
};

// The figures that a run tells.
std::vector<std::string> figureNames(const TraceOptions& options, const Scene& scene,
                                     const std::vector<BrfView>& views) {
  std::vector<std::string> names;
  ForwardResult told;
  if (std::any_of(scene.media.begin(), scene.media.end(), [](const SceneMedium& medium) { return medium.particles; }))
    told.absorbed_particles = Estimate();
  if (!options.only_picture && !options.brf.only)
    for (const NamedEstimate& figure : figuresOf(told)) names.push_back(figure.name);
  for (const BrfView& view : views) names.push_back(view.name);
  if (!views.empty()) names.push_back("brf_albedo");
  if (names.empty()) throw InvalidInput("--compare: must be without --only-picture");
  return names;
}

Scene turbidScene(const TraceOptions& options, const RunOptions& run, const Scene& scene) {
  if (scene.kinds[0].mesh->leaf_count == 0) throw InvalidInput("--turbid: must be for a scene with trees");
  Scene made = turbid(scene, *options.turbid, terminalProgress("voxelizing", run.quiet));
  made.camera = cameraOf(scene);  // the same picture
  made.name = fmt::format("{}, turbid in cells of {:.6g} m", scene.name, *options.turbid);
  return made;
}

int runTrace(const TraceOptions& options, const RunOptions& run) {
  if (!options.brf.csv.empty()) requireNamed(options.brf.csv, ".csv");
  if (!options.brf.mes.empty()) requireNamed(options.brf.mes, ".mes");
  if (!options.leaves.empty()) requireNamed(options.leaves, ".csv");
  if (!options.cells.empty()) requireCellFile(options.cells);
  if (!options.spectrum_out.empty()) requireNamed(options.spectrum_out, ".csv");
  if (!options.picture.empty()) requirePictureName(options.picture);
  if (!options.checkpoint.empty()) requireNamed(options.checkpoint, ".trace");
  Scene scene = readScene(options.scene, Media::taken);
  requireNoImageOf(scene, options.picture);
  apply(options.camera, scene);
  const bool pictured = scene.camera || !options.picture.empty() || options.only_picture;
  if (options.turbid) scene = turbidScene(options, run, scene);
  const std::vector<BrfView> views = brfViews(options.brf, scene);
  if (!options.brf.mes.empty() && (scene.sky.kind != SceneSky::Kind::none || scene.sun().diameter > 0.f))
    throw InvalidInput("--mes: must be for light from one direction, without [sky] and sun.diameter_deg");
  std::vector<NamedEstimate> reference;
  if (!options.compare.empty()) reference = readReference(options.compare, figureNames(options, scene, views));
  TraceRun trace(options, run, scene);
  if (!options.only_picture && !options.brf.only) trace.light();
  if (pictured && !options.brf.only && !interruptedAnywhere(run.team)) trace.picture();
  if (!views.empty() && !interruptedAnywhere(run.team)) trace.brf(views);
  const bool ended_early = interruptedAnywhere(run.team);
  if (run.team && run.team->rank() > 0) return 0;
  if (!reference.empty()) trace.compare(std::move(reference));

  if (run.json) fmt::print("{}\n", trace.json().dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  for (const std::string& file : {options.leaves, options.cells, options.spectrum_out, options.picture, options.brf.csv,
                                  options.brf.mes, options.checkpoint})
    if (!file.empty() && !run.json && std::filesystem::exists(file)) fmt::print("wrote {}\n", file);
  if (!trace.failure().empty()) fmt::print(stderr, "sunfleck: {}\n", trace.failure());
  if (ended_early) fmt::print(stderr, "sunfleck: ended early: what is told rests on the paths done\n");
  return ended_early || !trace.failure().empty() ? 1 : 0;
}

}  // namespace

void addTrace(CLI::App& app, RunOptions& options, int& status) {
  auto trace = std::make_shared<TraceOptions>();
  CLI::App* command =
      addCommand(app, options, "trace",
                 "Monte Carlo: where the sun's light ends up, leaf by leaf, with standard errors; and what a "
                 "camera sees of it. mpirun -n N sunfleck trace ... computes the same by N processes",
                 Ranks::any);
  addTraceOptions(*command, *trace);
  command->callback([trace, &options, &status] { status = runTrace(*trace, options); });
}

}  // namespace sunfleck::apps
