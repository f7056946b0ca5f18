#include "render/scene_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <span>
#include <vector>

#include "core/require.hpp"
#include "core/whole_file.hpp"
#include "leaves/measured_leaves.hpp"
#include "render/radians.hpp"
#include "render/toml_string.hpp"

namespace sunfleck {
namespace fs = std::filesystem;
namespace {

// The shortest decimal number for which `same` holds of what it is read as.
template <typename Same>
std::string shortest(double value, const Same& same) {
  constexpr int kAllDigits = 17;
  for (int digits = 1; digits <= kAllDigits; ++digits)
    if (const double read = std::strtod(fmt::format("{:.{}g}", value, digits).c_str(), nullptr); same(read)) {
      const std::string text = fmt::format("{}", read);
      return text == "-0" ? "-0.0" : text;  // TOML's whole numbers have no -0
    }
  throw InvalidInput(fmt::format("number in a scene = {}: must be finite", value));
}

std::string number(float value) {
  return shortest(double{value}, [&](double read) { return static_cast<float>(read) == value; });
}
std::string number(double value) {
  return shortest(value, [&](double read) { return read == value; });
}
// Of an angle [rad], the degrees that lead to it, within +-360 where it is beyond.
std::string degrees(float angle) {
  constexpr double kTurn = 2. * std::numbers::pi;
  if (std::abs(angle) > static_cast<float>(kTurn)) angle = static_cast<float>(std::fmod(double{angle}, kTurn));
  return shortest(double{angle} * (180. / std::numbers::pi), [&](double read) { return radiansOf(read) == angle; });
}

std::string list(std::span<const float> values) {
  std::string text;
  for (const float value : values) text += (text.empty() ? "[" : ", ") + number(value);
  return text + "]";
}
std::string list(const glm::vec3& v) {
  return list(std::array{v.x, v.y, v.z});
}
std::string perBand(const glm::vec3& bands) {
  return bands.x == bands.y && bands.y == bands.z ? number(bands.x) : list(bands);
}

std::string texts(const std::vector<std::string>& all) {
  if (all.size() == 1) return tomlString(all.front());
  std::string list;
  for (const std::string& text : all) list += (list.empty() ? "[" : ", ") + tomlString(text);
  return list + "]";
}

// The keys of what is different from the species or, without one, from the usual leaf.
std::string changedContents(const LeafByContents& leaf) {
  const LeafContents from = leaf.species.empty() ? LeafContents{} : measuredLeaf(leaf.species).contents;
  std::string keys;
  for (const LeafContent& content : leafContents())
    if (leaf.contents.*content.value != from.*content.value)
      keys += fmt::format("{}{} = {}", keys.empty() ? "" : ", ", content.name, number(leaf.contents.*content.value));
  return keys;
}

std::string inlineTable(const std::string& keys) {
  return keys.empty() ? "{}" : "{ " + keys + " }";
}

std::string bands(const std::array<WavelengthBand, kBands>& all) {
  std::string text;
  for (const WavelengthBand& band : all)
    text += (text.empty() ? "[" : ", ") +
            (band.low == band.high ? number(band.low) : fmt::format("[{}, {}]", number(band.low), number(band.high)));
  return text + "]";
}

class Writer {
 public:
  Writer(const Scene& scene, const fs::path& folder)
      : scene_(scene), folder_(fs::weakly_canonical(fs::absolute(folder))) {}

  std::string text() {
    key("name", tomlString(scene_.name));
    std::vector<char> stands(scene_.kinds.size());
    for (const Placement& tree : scene_.stand.trees) stands[tree.kind] = true;
    if (scene_.stand.trees.empty()) stands.assign(stands.size(), true);  // all may be planted again
    const bool treeless =
        scene_.kinds[static_cast<std::size_t>(std::ranges::find(stands, 1) - stands.begin())].mesh->leaf_count == 0;
    if (treeless && scene_.media.empty()) refuse("has neither trees nor media");
    const bool banded = scene_.bands && tellsByContents(stands);
    if (treeless || banded) table("leaf");
    if (banded) key("bands_nm", bands(*scene_.bands));
    if (treeless) writeOptics(scene_.kinds.front());
    for (std::size_t kind = 0; !treeless && kind < scene_.kinds.size(); ++kind)
      if (stands[kind]) writeTree(scene_.kinds[kind], std::ranges::count(stands, 1) > 1);
    for (const SceneMedium& medium : scene_.media) writeMedium(medium);
    writeStand(treeless);
    writeGround();
    for (const Sun& sun : scene_.suns) writeSun(sun);
    writeSky();
    if (scene_.camera) {
      table("camera");
      writeCamera(*scene_.camera);
    }
    for (const SavedCamera& saved : scene_.saved_cameras) {
      table("saved_camera", true);
      key("name", tomlString(saved.name));
      writeCamera(saved.camera);
    }
    return std::move(text_);
  }

 private:
  // Whether leaves that are written follow from the scene's bands.
  bool tellsByContents(const std::vector<char>& stands) const {
    const auto by = [](const auto& of) { return std::holds_alternative<LeafByContents>(of.description); };
    for (std::size_t kind = 0; kind < scene_.kinds.size(); ++kind)
      if (stands[kind] && by(scene_.kinds[kind])) return true;
    return std::ranges::any_of(scene_.media, by);
  }

  [[noreturn]] void refuse(const std::string& why) const {
    throw InvalidInput(fmt::format("scene \"{}\": {}: cannot be written as a scene file", scene_.name, why));
  }
  void table(const std::string& name, bool of_several = false) {
    text_ += of_several ? fmt::format("\n[[{}]]\n", name) : fmt::format("\n[{}]\n", name);
  }
  void key(const std::string& name, const std::string& value) { text_ += name + " = " + value + "\n"; }
  std::string path(const fs::path& file) const {
    const fs::path there = fs::weakly_canonical(fs::absolute(file)), from_here = there.lexically_relative(folder_);
    return tomlString((from_here.empty() ? there : from_here).generic_string());
  }

  // Reflectance and transmittance, as they are told; each key with `prefix` before it.
  void writeShares(const LeafDescription& leaf, const BandOptics& optics, const std::string& prefix) {
    if (const auto* contents = std::get_if<LeafByContents>(&leaf)) {
      if (!contents->species.empty()) key(prefix + "species", tomlString(contents->species));
      const std::string changed = changedContents(*contents);
      if (contents->species.empty() || !changed.empty()) key(prefix + "prospect", inlineTable(changed));
    } else if (const auto* tissue = std::get_if<LeafByTissue>(&leaf)) {
      key(prefix + "slab",
          inlineTable(fmt::format("absorption = {}, scattering = {}, thickness = {}", perBand(tissue->absorption),
                                  perBand(tissue->scattering), number(tissue->thickness))));
    } else {
      glm::vec3 reflectance, transmittance;
      for (std::size_t band = 0; band < kBands; ++band) {
        reflectance[static_cast<int>(band)] = optics[band].reflectance;
        transmittance[static_cast<int>(band)] = optics[band].transmittance;
      }
      key(prefix + "reflectance", perBand(reflectance));
      key(prefix + "transmittance", perBand(transmittance));
    }
  }

  // Keys of leaves, alone or each with `prefix` before it.
  void writeLeaf(const TreeKind& kind, const std::string& prefix) {
    const BandOptics& told = kind.told();
    writeShares(kind.description, told, prefix);
    glm::vec3 gloss;
    for (std::size_t band = 0; band < kBands; ++band) gloss[static_cast<int>(band)] = told[band].gloss;
    key(prefix + "gloss", perBand(gloss));
    key(prefix + "gloss_roughness", number(told[0].gloss_roughness));
    writeTextures(kind, prefix);
  }

  void writeTextures(const TreeKind& kind, const std::string& prefix) {
    const LeafTextures& textures = kind.textures;
    std::string keys;
    const auto add = [&](const std::string& name, const std::string& value) {
      keys += fmt::format("{}{} = {}", keys.empty() ? "" : ", ", name, value);
    };
    const auto image = [&](const std::string& name, const std::shared_ptr<const LeafTexture>& texture) {
      if (!texture) return;
      if (texture->file.empty()) refuse(fmt::format("maps of leaves of \"{}\" came from no file", kind.name));
      add(name, path(texture->file));
    };
    image("upper", textures.upper.detail);
    image("upper_gloss", textures.upper.gloss);
    image("lower", textures.lower.detail);
    image("lower_gloss", textures.lower.gloss);
    if (!keys.empty()) {
      add("albedo", perBand(textures.albedo));
      add("relief", number(textures.relief));
      key(prefix + "maps", inlineTable(keys));
    }
    if (const LeafUnderside& lower = textures.underside; lower.any()) {
      keys.clear();
      if (lower.reflectance) add("reflectance", perBand(*lower.reflectance));
      if (lower.gloss) add("gloss", perBand(*lower.gloss));
      if (lower.gloss_roughness) add("gloss_roughness", number(*lower.gloss_roughness));
      key(prefix + "lower", inlineTable(keys));
    }
  }

  void writeOptics(const TreeKind& kind) {
    writeLeaf(kind, "");
    table("wood");
    key("reflectance", perBand(kind.wood_reflectance));
  }

  void writeTree(const TreeKind& kind, bool of_several) {
    table("tree", of_several);
    const TreeRecipe& recipe = kind.recipe;
    if (!recipe.species.empty()) {
      const bool by_file = fs::path(recipe.species).extension() == ".toml";
      key("species", by_file ? path(recipe.species) : tomlString(recipe.species));
      key("seed", std::to_string(recipe.seed));
    } else if (!recipe.file.empty()) {
      key("file", path(recipe.file));
      if (!recipe.rules.leaf.empty()) key("leaf", texts(recipe.rules.leaf));
      if (!recipe.rules.wood.empty()) key("wood", texts(recipe.rules.wood));
      key("scale", number(recipe.rules.scale));
      if (recipe.rules.up != ImportRules::Up::of_format) key("up", tomlString(nameOf(recipe.rules.up)));
      if (recipe.rules.cards != ImportRules::Cards::cut) key("cards", tomlString(nameOf(recipe.rules.cards)));
      if (!recipe.rules.mesh.empty()) key("mesh", tomlString(recipe.rules.mesh));
    } else {
      refuse(fmt::format("its trees \"{}\" came from no species and no file", kind.name));
    }
    key("name", tomlString(kind.name));
    writeLeaf(kind, "leaf_");
    key("wood_reflectance", perBand(kind.wood_reflectance));
  }

  void writeMedium(const SceneMedium& medium) {
    table("medium", scene_.media.size() > 1);
    key("kind", medium.particles ? "\"particles\"" : "\"leaves\"");
    if (medium.grid) {
      if (medium.source.empty()) refuse("the cells of a medium came from no file");
      key("file", path(medium.source));
      key("scale", number(medium.density));
    } else {
      key(medium.particles ? "extinction" : "density", number(medium.density));
      if (std::isfinite(medium.box.low.x)) {
        std::array<float, 6> corners{};
        for (int axis = 0; axis < 3; ++axis) {
          corners[static_cast<std::size_t>(axis)] = medium.box.low[axis];
          corners[static_cast<std::size_t>(axis) + 3] = medium.box.high[axis];
        }
        key("box", list(corners));
      } else {
        key("bottom", number(medium.box.low.z));
        key("top", number(medium.box.high.z));
      }
    }
    if (medium.particles) {
      glm::vec3 albedo;
      for (std::size_t band = 0; band < kBands; ++band)
        albedo[static_cast<int>(band)] = medium.optics[band].reflectance;
      key("albedo", perBand(albedo));
      key("asymmetry", number(medium.asymmetry));
      return;
    }
    writeShares(medium.description, medium.optics, "");
    if (!medium.angles.empty()) key("angles", tomlString(medium.angles));
  }

  void writeStand(bool treeless) {
    table("stand");
    const Stand& stand = scene_.stand;
    if (!treeless && stand.trees.empty()) return key("kind", "\"none\"");
    key("kind", stand.period ? "\"periodic\"" : treeless ? "\"single\"" : "\"positions\"");
    if (stand.period) key("period", list(std::array{stand.period->x, stand.period->y}));
    if (treeless) return;
    text_ += "positions = [\n";
    for (const Placement& tree : stand.trees) {
      if (tree.position.z != 0.f) refuse("a tree stands above or below the ground");
      text_ += fmt::format("  [{}, {}", number(tree.position.x), number(tree.position.y));
      if (tree.rotation != 0.f) text_ += ", " + degrees(tree.rotation);
      text_ += ", " + tomlString(scene_.kindOf(tree).name) + "],\n";
    }
    text_ += "]\n";
  }

  void writeGround() {
    table("ground");
    if (scene_.ground_rpv) {
      key("kind", "\"rpv\"");
      std::string rows;
      for (const RpvGround& band : *scene_.ground_rpv)
        rows += (rows.empty() ? "[" : ", ") + list(std::array{band.rho0, band.k, band.theta, band.rho_c});
      key("rpv", rows + "]");
    } else if (scene_.ground_texture[0]) {
      if (scene_.ground_texture_file.empty()) refuse("the texture of its ground came from no file");
      key("kind", "\"texture\"");
      key("texture", path(scene_.ground_texture_file));
      key("texture_size", number(scene_.ground_texture[0]->size));
    } else {
      key("kind", "\"lambert\"");
      key("albedo", perBand(scene_.ground_albedo));
    }
  }

  void writeSun(const Sun& sun) {
    table("sun", scene_.suns.size() > 1);
    key("zenith_deg", degrees(sun.zenith));
    key("azimuth_deg", degrees(sun.azimuth));
    key("irradiance", perBand(sun.irradiance));
    key("diameter_deg", degrees(sun.diameter));
  }

  void writeSky() {
    using Kind = SceneSky::Kind;
    const SceneSky& sky = scene_.sky;
    table("sky");
    constexpr std::array names{"none", "uniform", "overcast", "preetham", "image"};
    key("kind", tomlString(names[static_cast<std::size_t>(sky.kind)]));
    // A list is of colours, a number keeps the sky's own.
    if (sky.kind != Kind::none && sky.irradiance) {
      const glm::vec3 irradiance(*sky.irradiance);
      key("irradiance", sky.own_colours ? number(irradiance.x) : list(irradiance));
    }
    if (sky.kind == Kind::preetham) {
      key("turbidity", number(sky.turbidity));
      key("coloured_sun", sky.coloured_sun ? "true" : "false");
    }
    if (sky.kind == Kind::image) {
      if (sky.file.empty()) refuse("its sky came from no file");
      key("file", path(sky.file));
      key("rotation_deg", degrees(sky.rotation));
    }
  }

  void writeCamera(const Camera& camera) {
    key("target", list(camera.target));
    key("elevation_deg", degrees(camera.elevation));
    key("azimuth_deg", degrees(camera.azimuth));
    key("half_width", number(camera.half_width));
    key("field_of_view_deg", degrees(camera.field_of_view));
    key("width", std::to_string(camera.width));
    key("height", std::to_string(camera.height));
  }

  const Scene& scene_;
  fs::path folder_;
  std::string text_;
};

}  // namespace

std::string sceneText(const Scene& scene, const fs::path& folder) {
  return Writer(scene, folder).text();
}

void writeScene(const fs::path& file, const Scene& scene) {
  if (file.extension() != ".toml")
    throw InvalidInput(
        fmt::format("{}: has the extension \"{}\": a scene's must be .toml", file.string(), file.extension().string()));
  requireWritable(file);
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  writeWhole(file, sceneText(scene, folder));
}

}  // namespace sunfleck
