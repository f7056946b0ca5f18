#include "render/detail/scene_leaf_file.hpp"

#include <algorithm>

#include "leaves/measured_leaves.hpp"
#include "render/leaf_texture_file.hpp"

namespace sunfleck::detail {
namespace {

// Ways in which a table may tell its leaves.
const std::vector<std::vector<std::string>>& ways() {
  static const std::vector<std::vector<std::string>> kWays{
      {"species", "prospect"}, {"slab"}, {"reflectance", "transmittance"}};
  return kWays;
}

// Throws where the table tells its leaves in more than one way.
void requireOneWay(const SceneTable& table, const std::string& prefix) {
  std::string first;
  for (const std::vector<std::string>& way : ways()) {
    std::string found;
    for (const std::string& key : way)
      if (found.empty() && table.has(prefix + key)) found = prefix + key;
    if (!first.empty() && !found.empty())
      throw InvalidInput(
          fmt::format("{}: [{}] has both {} and {}: must be one of them", table.file(), table.name(), first, found));
    if (first.empty()) first = found;
  }
}

LeafByTissue readTissue(SceneTable& table, const std::string& key) {
  SceneTable slab = table.within(key);
  for (const char* part : {"absorption", "scattering", "thickness"})
    if (!slab.has(part))
      throw InvalidInput(fmt::format("{}: {} has no {}: must have absorption, scattering and thickness", slab.file(),
                                     slab.name(), part));
  const LeafByTissue tissue{.absorption = slab.perBand("absorption", {}, 1e6),
                            .scattering = slab.perBand("scattering", {}, 1e6),
                            .thickness = slab.number("thickness", 0., 0., 1000., "in [0, 1000] mm")};
  slab.done();
  return tissue;
}

LeafByContents readContents(SceneTable& table, const std::string& prefix) {
  const std::string species = prefix + "species", prospect_key = prefix + "prospect";
  LeafByContents leaf;
  if (table.has(species)) {
    leaf.species = table.text(species, "");
    leaf.contents = measuredLeaf(leaf.species, fmt::format("{}: {}.{}", table.file(), table.name(), species)).contents;
  }
  if (table.has(prospect_key)) {
    SceneTable contents = table.within(prospect_key);
    std::vector<std::pair<std::string, double>> values;
    for (const LeafContent& content : leafContents()) {
      const std::string name(content.name);
      const std::string rule =
          fmt::format("in [{}, {}]{}{}", content.low, content.high, content.unit.empty() ? "" : " ", content.unit);
      if (contents.has(name)) values.emplace_back(name, contents.number(name, 0., content.low, content.high, rule));
    }
    contents.done();
    setContents(leaf.contents, values, fmt::format("{}: {}.", table.file(), contents.name()));
  }
  return leaf;
}

LeafSideTextures readSide(SceneTable& maps, const std::string& side, const std::filesystem::path& folder) {
  LeafSideTextures read;
  const auto image = [&](const std::string& key, float most) {
    if (!maps.has(key)) return std::shared_ptr<const LeafTexture>();
    const std::string name = maps.text(key, "");
    if (name.empty())
      throw InvalidInput(fmt::format("{}: {}.{} = \"\": must be an image's file", maps.file(), maps.name(), key));
    return readLeafTexture(folder / name, most);
  };
  read.detail = image(side, kMostLeafAlbedo);
  read.gloss = image(side + "_gloss", 1.f);
  return read;
}

// What the table tells by `maps` takes the place of all images that there were, `lower` that of all numbers of the
// lower side; empty, they take them away.
void readTextures(SceneTable& table, const std::string& prefix, LeafTextures& textures) {
  const std::filesystem::path folder = std::filesystem::path(table.file()).parent_path();
  const bool has_maps = table.has(prefix + "maps"), has_lower = table.has(prefix + "lower");
  if (has_maps) {
    SceneTable maps = table.within(prefix + "maps");
    LeafTextures read{.upper = readSide(maps, "upper", folder), .lower = readSide(maps, "lower", folder)};
    read.albedo = maps.perBand("albedo", read.albedo, double{kMostLeafAlbedo});
    read.relief = maps.number("relief", read.relief, 0., 1000., "in [0, 1000] mm");
    maps.done();
    for (const char* key : {"albedo", "relief"})
      if (maps.has(key) && !read.upper.any() && !read.lower.any())
        throw InvalidInput(fmt::format("{}: {} has {} and no image: must be with an image it counts for", maps.file(),
                                       maps.name(), key));
    read.underside = textures.underside;
    textures = std::move(read);
    if (textures.lower.any() && !has_lower) textures.underside = {};
  }
  if (has_lower) {
    SceneTable lower = table.within(prefix + "lower");
    textures.underside = {};
    if (lower.has("reflectance")) textures.underside.reflectance = lower.perBand("reflectance", {});
    if (lower.has("gloss")) textures.underside.gloss = lower.perBand("gloss", {});
    if (lower.has("gloss_roughness"))
      textures.underside.gloss_roughness =
          static_cast<float>(lower.number("gloss_roughness", 0., 0.05, 1., "in [0.05, 1]"));
    lower.done();
    if (textures.underside.any() && !has_maps) textures.lower = {};
  }
  if (has_maps || has_lower) validate(textures, fmt::format("{}: [{}]", table.file(), table.name()));
}

}  // namespace

LightBands readLightBands(SceneTable& leaf) {
  if (!leaf.has("bands_nm")) return std::nullopt;
  const std::vector<std::pair<double, double>> read =
      leaf.ranges("bands_nm", kBands, kFirstWavelength, kLastWavelength,
                  "three bands: each [from, to], rising, or one wavelength, in [400, 2500] nm");
  std::array<WavelengthBand, kBands> bands;
  for (std::size_t band = 0; band < kBands; ++band) bands[band] = {read[band].first, read[band].second};
  return bands;
}

bool tellsLeafShares(const SceneTable& table, const std::string& prefix) {
  return std::ranges::any_of(ways(), [&](const auto& way) {
    return std::ranges::any_of(way, [&](const std::string& key) { return table.has(prefix + key); });
  });
}

void readLeafShares(SceneTable& table, const std::string& prefix, const LightBands& bands, LeafDescription& leaf,
                    BandOptics& optics) {
  requireOneWay(table, prefix);
  const bool slab = table.has(prefix + "slab");
  if (slab || table.has(prefix + "species") || table.has(prefix + "prospect")) {
    leaf = slab ? LeafDescription(readTissue(table, prefix + "slab")) : readContents(table, prefix);
    optics = bandOptics(leaf, bands, optics);
    return;
  }
  if (table.has(prefix + "reflectance") || table.has(prefix + "transmittance")) leaf = LeafByNumbers{};
  glm::vec3 reflectance, transmittance;
  for (int band = 0; band < kBands; ++band) {
    reflectance[band] = optics[static_cast<std::size_t>(band)].reflectance;
    transmittance[band] = optics[static_cast<std::size_t>(band)].transmittance;
  }
  reflectance = table.perBand(prefix + "reflectance", reflectance);
  transmittance = table.perBand(prefix + "transmittance", transmittance);
  for (int band = 0; band < kBands; ++band) {
    optics[static_cast<std::size_t>(band)].reflectance = reflectance[band];
    optics[static_cast<std::size_t>(band)].transmittance = transmittance[band];
  }
}

void readOptics(TreeKind& kind, SceneTable& leaf, const std::string& leaf_prefix, SceneTable& wood,
                const std::string& wood_prefix, const LightBands& bands) {
  readLeafShares(leaf, leaf_prefix, bands, kind.description, kind.leaf);
  glm::vec3 gloss;
  for (int band = 0; band < kBands; ++band) gloss[band] = kind.leaf[static_cast<std::size_t>(band)].gloss;
  gloss = leaf.perBand(leaf_prefix + "gloss", gloss);
  const auto roughness = static_cast<float>(
      leaf.number(leaf_prefix + "gloss_roughness", double{kind.leaf[0].gloss_roughness}, 0.05, 1., "in [0.05, 1]"));
  for (int band = 0; band < kBands; ++band) {
    LeafOptics& optics = kind.leaf[static_cast<std::size_t>(band)];
    optics.gloss = gloss[band];
    optics.gloss_roughness = roughness;
    validate(optics);
  }
  readTextures(leaf, leaf_prefix, kind.textures);
  kind.wood_reflectance = wood.perBand(wood_prefix + "reflectance", kind.wood_reflectance);
}

}  // namespace sunfleck::detail
