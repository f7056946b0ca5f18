#include "render/sweep_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <utility>

#include "core/detail/toml_file.hpp"
#include "core/require.hpp"
#include "leaves/light_bands.hpp"
#include "leaves/measured_leaves.hpp"
#include "leaves/prospect.hpp"
#include "render/detail/scene_table.hpp"

namespace sunfleck {
namespace {

using detail::SceneTable;

// A list of numbers that may be left out: then one entry without a value, what the scene has.
std::vector<std::optional<double>> listedOrOwn(SceneTable& table, const std::string& key, double low, double high,
                                               const std::string& rule) {
  if (!table.has(key)) return {std::nullopt};
  const std::vector<double> values = table.listed(key, low, high, rule);
  return {values.begin(), values.end()};
}

std::optional<float> single(const std::optional<double>& value) {
  return value ? std::optional(static_cast<float>(*value)) : std::nullopt;
}

LeafOptics leafOf(double reflectance, double transmittance) {
  const LeafOptics leaf{.reflectance = static_cast<float>(reflectance),
                        .transmittance = static_cast<float>(transmittance)};
  validate(leaf);
  return leaf;
}

// The leaves as one of four ways tells them: albedo, pairs of reflectance and transmittance, species at wavelengths,
// bands of the scene.
std::vector<SweepOptics> readLeaves(SceneTable& table, const std::string& file) {
  const std::string share = "in [0, 1]";
  const bool albedo = table.has("albedo"), pairs = table.has("reflectance") || table.has("transmittance"),
             bands = table.has("band"), species = table.has("species") || table.has("wavelength_nm");
  if (albedo + pairs + bands + species > 1)
    throw InvalidInput(file +
                       ": [leaf]: must have one alone of albedo, reflectance with transmittance, species with "
                       "wavelength_nm, and band");
  std::vector<SweepOptics> leaves;
  if (albedo)
    for (const double value : table.listed("albedo", 0., 1., share))
      leaves.push_back({.leaf = leafOf(0.5 * value, 0.5 * value)});
  if (bands)
    for (const double value : table.listed("band", 0., 2., "0, 1 or 2")) {
      if (value != static_cast<int>(value))
        throw InvalidInput(fmt::format("{}: leaf.band = {}: must be 0, 1 or 2", file, value));
      leaves.push_back({.band = static_cast<int>(value)});
    }
  if (pairs) {
    if (!table.has("reflectance") || !table.has("transmittance"))
      throw InvalidInput(file + ": [leaf]: must have both reflectance and transmittance, or none");
    const std::vector<double> up = table.listed("reflectance", 0., 1., share, false);
    const std::vector<double> through = table.listed("transmittance", 0., 1., share, false);
    if (up.size() != through.size())
      throw InvalidInput(
          fmt::format("{}: [leaf] has {} of reflectance and {} of transmittance: must be as many, they "
                      "are taken in pairs",
                      file, up.size(), through.size()));
    std::set<std::pair<double, double>> seen;
    for (std::size_t i = 0; i < up.size(); ++i) {
      leaves.push_back({.leaf = leafOf(up[i], through[i])});
      if (!seen.insert({up[i], through[i]}).second)
        throw InvalidInput(fmt::format("{}: [leaf]: reflectance {} with transmittance {}: must be there once", file,
                                       up[i], through[i]));
    }
  }
  if (species) {
    if (!table.has("species") || !table.has("wavelength_nm"))
      throw InvalidInput(file + ": [leaf]: must have both species and wavelength_nm, or none");
    const std::vector<double> wavelengths =
        table.listed("wavelength_nm", kFirstWavelength, kLastWavelength, "in [400, 2500] nm");
    for (const std::string& name : table.texts("species")) {
      const LeafSpectrum spectrum = prospect(measuredLeaf(name, file + ": leaf.species").contents);
      for (const double wavelength : wavelengths)
        leaves.push_back({.leaf = leafOptics(meanIn(spectrum, {wavelength, wavelength}))});
    }
  }
  if (leaves.empty()) leaves.emplace_back();
  return leaves;
}

void readModels(SweepFile& sweep, SceneTable& table) {
  if (!table.has("models")) return;
  sweep.monte_carlo = false;
  for (const std::string& name : table.texts("models")) {
    if (name == "mc") sweep.monte_carlo = true;
    const std::optional<Model> model = modelNamed(name);
    if (model) sweep.models.push_back(*model);
    if (name != "mc" && !model)
      throw InvalidInput(
          fmt::format("{}: models has \"{}\": must be of mc, {}", sweep.path.string(), name, modelNames()));
  }
}

SweepFile readTable(const toml::table& root, const std::filesystem::path& path) {
  SweepFile sweep{.path = path};
  const std::string file = path.string();
  for (const auto& [key, node] : root) {
    static constexpr std::array known{"scenes", "models", "sun", "leaf", "wood", "ground", "effort"};
    if (std::find(known.begin(), known.end(), key.str()) == known.end())
      throw InvalidInput(fmt::format("{}:{}: unknown key \"{}\"; see: sunfleck --help sweep", file,
                                     node.source().begin.line, key.str()));
  }
  const auto table = [&](const char* name) { return SceneTable(root.get(name), file, name, "sweep"); };
  SceneTable top(&root, file, "", "sweep"), sun = table("sun"), leaf = table("leaf"), wood = table("wood"),
                                            ground = table("ground"), effort = table("effort");
  if (!top.has("scenes")) throw InvalidInput(file + ": scenes: must be there, a list of names of scenes and files");
  sweep.scenes = top.texts("scenes");
  readModels(sweep, top);

  const auto zeniths = listedOrOwn(sun, "zenith_deg", 0., 89.9, "in [0, 89.9]");
  const auto azimuths = listedOrOwn(sun, "azimuth_deg", -360., 360., "in [-360, 360]");
  const std::vector<SweepOptics> leaves = readLeaves(leaf, file);
  const auto woods = listedOrOwn(wood, "reflectance", 0., 1., "in [0, 1]");
  sweep.with_wood = wood.flag("traced", true);
  const auto grounds = listedOrOwn(ground, "albedo", 0., 1., "in [0, 1]");
  if (effort.has("paths")) sweep.paths = effort.number("paths", 0., 64., 1e15, "in [64, 1e15]");
  if (effort.has("target")) sweep.target = effort.number("target", 0., 1e-6, 1., "a share in [1e-6, 1]");
  if (effort.has("seed"))
    sweep.seed = static_cast<std::uint64_t>(effort.count("seed", 1, std::numeric_limits<int>::max()));
  for (const SceneTable* read : {&sun, &leaf, &wood, &ground, &effort}) read->done();

  double rows = static_cast<double>(sweep.rowsEach());
  for (const std::size_t count :
       {sweep.scenes.size(), zeniths.size(), azimuths.size(), leaves.size(), woods.size(), grounds.size()})
    rows *= static_cast<double>(count);
  if (rows > static_cast<double>(kMostSweepRows))
    throw InvalidInput(fmt::format("{}: {:.0f} rows: must be at most {}", file, rows, kMostSweepRows));
  for (const auto& zenith : zeniths)
    for (const auto& azimuth : azimuths) sweep.suns.push_back({zenith, azimuth});
  for (const SweepOptics& of_leaf : leaves)
    for (const auto& of_wood : woods)
      for (const auto& of_ground : grounds) {
        SweepOptics& optics = sweep.optics.emplace_back(of_leaf);
        optics.wood_reflectance = single(of_wood);
        optics.ground_albedo = single(of_ground);
      }
  return sweep;
}

}  // namespace

std::string SweepFile::sceneFile(std::size_t scene) const {
  const std::filesystem::path file(scenes[scene]);
  return file.has_extension() ? (path.parent_path() / file).string() : scenes[scene];
}

SweepFile readSweepFile(const std::filesystem::path& file) {
  SweepFile sweep;
  detail::readToml(file, [&](const toml::table& table) { sweep = readTable(table, file); });
  return sweep;
}

std::string sweepFileHelp() {
  return R"(A sweep is a TOML file: scenes x suns x optics x models. Every combination becomes a row of one table. Where a list
stands, one number will do; every key but scenes may be left out.

scenes = ["cherry", "orchard.toml"]   # built-in scenes, scene files and meshes; files are sought beside this one
models = ["mc"]                       # mc: Monte Carlo's own figures; ss, spp, sppg, sppr, nstreamg, pp: errors of these
                                      # models against it, as validate tells them

[sun]                                 # every zenith angle with every azimuth; the scene's own if not given
zenith_deg = [0, 30, 60]              # 0 to 89.9
azimuth_deg = [0]                     # -360 to 360

[leaf]                                # one of four, for leaves of all kinds; band 0 of the scene if not given
albedo = [0.1, 0.5, 0.95]             # half of it reflected, half passed on
# reflectance = [0.10, 0.45]          # in pairs with ...
# transmittance = [0.05, 0.40]
# species = ["beech", "corn"]         # every species, see sunfleck leaf --list, at every one of ...
# wavelength_nm = [550, 850]          # 400 to 2500
# band = [0, 1, 2]                    # the scene's own in these bands, with its wood and ground

[wood]
reflectance = [0.3]                   # the scene's own if not given
traced = true                         # false leaves the wood out; models know leaves alone, and validate does so

[ground]
albedo = [0.0]                        # the scene's own if not given; above 0 for periodic stands and without models

[effort]                              # of each row
paths = 4e6                           # 64 to 1e15
# target = 0.01                       # as many paths as it takes, at most `paths`, for this relative standard error
                                      # of every share of the light above 1 %
seed = 1                              # --seed has the last word

Up to 16 optics of a scene and a sun are traced on the same paths, in the order given: they cost little more than one.
Their figures have the same noise, so that differences between them are sharper than their standard errors say.
)";
}

}  // namespace sunfleck
