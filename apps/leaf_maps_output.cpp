#include "apps/leaf_maps_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/terminal.hpp"
#include "core/distinct_files.hpp"
#include "core/require.hpp"
#include "core/whole_file.hpp"
#include "leaves/leaf_map_fit.hpp"
#include "leaves/leaf_textures.hpp"
#include "render/image_file.hpp"
#include "render/leaf_texture_file.hpp"
#include "render/toml_string.hpp"

namespace sunfleck::apps {
namespace {

namespace fs = std::filesystem;

struct FittedFiles {
  fs::path upper, lower, scene;  // the second empty: none
};

// Throws unless all of them can be written, so that none is where one cannot.
FittedFiles namesOf(const LeafMapFiles& files) {
  const fs::path output(files.output);
  const auto with = [&](const std::string& part) {
    return output.parent_path() / (output.stem().string() + part + output.extension().string());
  };
  FittedFiles names{
      .upper = with("_upper"), .lower = files.lower_reflectance.empty() ? fs::path() : with("_lower"), .scene = output};
  names.scene.replace_extension(".toml");
  requirePictureName(names.upper);
  if (!names.lower.empty()) requirePictureName(names.lower);
  requireWritable(names.scene);
  for (const fs::path* name : {&names.upper, &names.lower, &names.scene})
    for (const std::string* given : {&files.upper_reflectance, &files.lower_reflectance, &files.transmittance})
      requireOther(*name, *given);
  return names;
}

MeasuredLeafMaps readMaps(const LeafMapFiles& files, LeafTexture& size) {
  MeasuredLeafMaps measured;
  std::vector<std::shared_ptr<const LeafTexture>> read;
  const auto colours = [&](const std::string& file) {
    read.push_back(readLeafTexture(file, 1.f));
    const LeafTexture &image = *read.back(), &first = *read.front();
    if (image.width != first.width || image.height != first.height)
      throw InvalidInput(fmt::format("{}: has {} x {} pixels: must have {} x {} as {}", file, image.width, image.height,
                                     first.width, first.height, first.file.string()));
    return image.colour;
  };
  measured.reflectance = colours(files.upper_reflectance);
  measured.transmittance = colours(files.transmittance);
  if (!files.lower_reflectance.empty()) measured.lower_reflectance = colours(files.lower_reflectance);
  measured.on_leaf.assign(measured.reflectance.size(), true);
  for (const auto& image : read)
    for (std::size_t i = 0; i < image->alpha.size(); ++i)
      if (image->alpha[i] < 0.5f) measured.on_leaf[i] = false;
  size.width = read.front()->width;
  size.height = read.front()->height;
  return measured;
}

// The largest of both sides, which a colour of 1 is to stand for.
glm::vec3 albedoOf(const LeafMapFit& fit) {
  glm::vec3 most(1e-6f);
  for (const auto* gammas : {&fit.gamma, &fit.lower_gamma})
    for (const glm::vec3& gamma : *gammas)
      for (int band = 0; band < kBands; ++band) most[band] = std::max(most[band], gamma[band]);
  return most;
}

std::string list(const glm::vec3& bands) {
  return fmt::format("[{}, {}, {}]", bands.x, bands.y, bands.z);
}

}  // namespace

std::string fitMapsReport(const LeafMapFiles& files, bool json) {
  const FittedFiles names = namesOf(files);
  LeafTexture texture;
  const MeasuredLeafMaps measured = readMaps(files, texture);
  const auto start = std::chrono::steady_clock::now();
  LeafMapFit fit;
  try {
    fit = fitLeafMaps(measured, files.thickness, [](double) { return !interrupted(); });
  } catch (const InvalidInput& e) {
    throw InvalidInput(std::string("--fit-maps: ") + e.what());
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const glm::vec3 albedo = albedoOf(fit);
  float relief = 0.f;
  for (const float delta : fit.delta) relief = std::max(relief, std::abs(delta));
  if (relief == 0.f) relief = static_cast<float>(files.thickness);
  for (const float delta : fit.delta) texture.alpha.push_back(std::clamp(0.5f + 0.5f * delta / relief, 0.f, 1.f));
  const auto write = [&](const fs::path& file, const std::vector<glm::vec3>& gammas) {
    texture.colour.clear();
    for (const glm::vec3& gamma : gammas) texture.colour.push_back(gamma / albedo);
    writeLeafTexture(file, texture);
  };
  const bool lower = !fit.lower_gamma.empty();
  write(names.upper, fit.gamma);
  if (lower) write(names.lower, fit.lower_gamma);
  const LeafByTissue& tissue = fit.tissue;
  const std::string lower_key = lower ? fmt::format(", lower = {}", tomlString(names.lower.filename().string())) : "";
  writeWhole(names.scene, fmt::format("# A leaf found from measured maps by sunfleck leaf --fit-maps; 1/mm and mm.\n"
                                      "[leaf]\nslab = {{ absorption = {}, scattering = {}, thickness = {} }}\n"
                                      "maps = {{ upper = {}{}, albedo = {}, relief = {} }}\n",
                                      list(tissue.absorption), list(tissue.scattering), tissue.thickness,
                                      tomlString(names.upper.filename().string()), lower_key, list(albedo), relief));
  if (json) {
    const auto bands = [](const auto& v) { return nlohmann::json{v[0], v[1], v[2]}; };
    nlohmann::ordered_json all{{"absorption_per_mm", bands(tissue.absorption)},
                               {"scattering_per_mm", bands(tissue.scattering)},
                               {"thickness_mm", tissue.thickness},
                               {"albedo", bands(albedo)},
                               {"relief_mm", relief},
                               {"rms_transmittance", bands(fit.rms_transmittance)},
                               {"places", fit.places},
                               {"capped", fit.capped},
                               {"at_limit", fit.at_limit},
                               {"rounds", fit.rounds},
                               {"converged", fit.converged},
                               {"seconds", seconds}};
    return all.dump(2) + "\n";
  }
  std::string text = fmt::format("Leaf behind {} places of {} x {}\n\n", fit.places, texture.width, texture.height);
  const auto line = [&](const char* name, const auto& v, const char* unit) {
    text += fmt::format("  {:<18}{:>12.6g}{:>12.6g}{:>12.6g} {}\n", name, v[0], v[1], v[2], unit);
  };
  text += fmt::format("  {:<18}{:>12}{:>12}{:>12}\n", "", "red", "green", "blue");
  line("absorption", tissue.absorption, "1/mm");
  line("scattering", tissue.scattering, "1/mm");
  line("largest gamma", albedo, "");
  line("transmittance off", fit.rms_transmittance, "root mean square");
  text += fmt::format("\n  thickness {:g} mm, at places by up to {:.4g} mm more or less\n", tissue.thickness, relief);
  text += fmt::format("  {} places would reflect and let through more than arrives: they absorb nothing\n", fit.capped);
  text +=
      fmt::format("  {} places ended at the limits of thickness, 0 and {:g} mm\n", fit.at_limit, 4. * tissue.thickness);
  text += fmt::format("  {} rounds in {:.2f} s{}\n\n", fit.rounds, seconds, fit.converged ? "" : ", not converged");
  text += fmt::format("wrote {}{}, {}\n", names.upper.string(), lower ? ", " + names.lower.string() : "",
                      names.scene.string());
  return text;
}

}  // namespace sunfleck::apps
