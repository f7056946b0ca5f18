#include "apps/trace_options.hpp"

#include <charconv>
#include <string_view>

#include "apps/run_options.hpp"
#include "apps/slab_options.hpp"
#include "core/require.hpp"

namespace sunfleck::apps {
namespace {

// "90", "90s", "1.5m", "2h" in seconds.
double secondsOf(const std::string& text) {
  double value = 0.;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
  const double scale = unit.empty() || unit == "s" ? 1. : unit == "m" ? 60. : unit == "h" ? 3600. : 0.;
  if (error != std::errc() || !(value * scale > 0.) || !(value * scale < 1e9))
    throw InvalidInput("--time " + text + ": must be seconds, or a number with s, m or h, above 0");
  return value * scale;
}

}  // namespace

Extent extentOf(const TraceOptions& options) {
  Extent extent;
  if (!options.target.empty()) {
    const std::optional<double> target = shareOf(options.target);
    if (!target) throw InvalidInput("--target " + options.target + ": must be a relative error such as 0.5% or 0.005");
    extent.target = *target;
  }
  if (!options.time.empty()) extent.seconds = secondsOf(options.time);
  if (!options.part.empty()) extent.part = partNamed(options.part);
  return extent;
}

void addTraceOptions(CLI::App& command, TraceOptions& options) {
  addSceneOptions(command, options.scene);
  addCameraOptions(command, options.camera, "--look-at");
  command
      .add_option("--paths", options.paths,
                  "Paths of light from the sun (default 4e6; with --target, as many as it takes)")
      ->check(numberIn(64., 1e15, "in [64, 1e15]"));
  command.add_option("--samples", options.samples, "Paths through each pixel of the picture (default 64)")
      ->transform(wholeNumberIn(1., 1e6, "a whole number, 1 to 1e6"));
  command.add_option("--band", options.band, "Band of the scene's optics: 0, 1 or 2, red, green or blue (default 0)")
      ->check(numberIn(0., 2., "0, 1 or 2"));
  command.add_option("-o,--leaves", options.leaves, "CSV to write: irradiance of each leaf and its standard error");
  command.add_option("--picture", options.picture, "Picture to write: .exr (radiances) or .png");
  command.add_flag("--only-picture", options.only_picture, "Trace the picture alone")->excludes("--leaves");
  command.add_flag("--by-eye", options.by_eye,
                   "Trace the picture by paths from the camera alone, also where paths of light are less noisy");
  addDisplayOptions(command, options.display);
  CLI::Option* all_bands =
      command.add_flag("--all-bands", options.all_bands, "Trace the three bands of the scene on the same paths")
          ->excludes("--band");
  command
      .add_option(
          "--cells", options.cells,
          "CSV or .vdb to write: light absorbed by leaves and by wood in each cell of the stand's box, or of one "
          "period, and its standard error")
      ->excludes("--only-picture");
  command.add_option("--cell", options.cell, "Side of these cells (default 0.25 m)")
      ->check(numberIn(1e-6, 1e6, "in [1e-6, 1e6] m"))
      ->needs("--cells");
  CLI::Option* spectrum =
      command
          .add_option("--spectrum", options.spectrum,
                      "CSV of any number of bands, the optics of all trees in each: name,leaf_reflectance,"
                      "leaf_transmittance[,wood_reflectance[,ground_albedo]]. No picture is traced")
          ->excludes(all_bands)
          ->excludes("--picture")
          ->excludes("--only-picture");
  for (const char* other : {"--albedo", "--leaf-species", "--leaf-prospect", "--leaf-bands"}) spectrum->excludes(other);
  command.add_option("--spectrum-out", options.spectrum_out, "CSV to write: the shares of the light of each of them")
      ->needs(spectrum);
  addBrfOptions(command, options.brf);
  for (const char* other : {"--brf", "--brf-views", "--only-brf"}) spectrum->excludes(other);
  command
      .add_option("--compare", options.compare,
                  "CSV file name,value,standard_error of figures to compare with: names as in --json, brf:ZENITH of "
                  "--brf, brf:ZENITH:AZIMUTH of --brf-views, brf_albedo. Tells per cent, z and the score of RAMI-IV")
      ->excludes(spectrum)
      ->excludes("--all-bands");
  command
      .add_option("--other-leaf", options.other_leaf,
                  "Tell the shares also for leaves of this reflectance and transmittance, from the same paths")
      ->expected(2)
      ->check(numberIn(0., 1., "in [0, 1]"))
      ->excludes(all_bands)
      ->excludes(spectrum)
      ->excludes("--only-picture");
  command.add_option("--checkpoint", options.checkpoint,
                     "File of the run's state (.trace): written now and then and at the end. When it is there, the run "
                     "goes on from it");
  command.add_option("--write-every", options.write_every, "Seconds between two writes of that file (default 60)")
      ->check(numberIn(0., 1e9, "in [0, 1e9] s"))
      ->needs("--checkpoint");
  CLI::Option* target = command.add_option("--target", options.target,
                                           "Stop at this relative error, such as 0.5%, of all shares above 1 %, of "
                                           "every view, and of the picture's pixels (root mean square, "
                                           "by the mean)");
  command.add_option("--time", options.time, "Stop after so long: seconds, or with m or h, such as 10m");
  command
      .add_option("--part", options.part, "Compute the K-th of N equal parts, K/N, for sunfleck merge to put together")
      ->needs("--checkpoint")
      ->excludes(target);
  command
      .add_option("--turbid", options.turbid,
                  "Trace the leaves of the trees as a turbid medium: their density and orientation in cells of this "
                  "side, in metres. Wood stays")
      ->check(numberIn(2e-5, 1e6, "in [2e-5, 1e6] m"))
      ->excludes("--leaves");
  command.add_flag("--without-wood", options.without_wood, "Leave the wood out");
}

}  // namespace sunfleck::apps
