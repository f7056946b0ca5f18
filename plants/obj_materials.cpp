#include "plants/detail/obj_materials.hpp"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <sstream>
#include <system_error>
#include <tuple>

#include "core/require.hpp"
#include "plants/detail/input_file.hpp"

namespace sunfleck::detail {
namespace fs = std::filesystem;
namespace {

// Of one that is a kilobyte in memory and nine bytes in a file.
constexpr std::size_t kMostMaterials = 10'000;
constexpr std::size_t kMostFiles = 100;

// The whole of what follows mtllib, then its words.
std::vector<std::string> filesOf(const std::vector<std::string_view>& named) {
  std::vector<std::string> files;
  for (const std::string_view rest : named) {
    files.emplace_back(rest);
    if (rest.find(' ') != std::string_view::npos) {
      std::istringstream words{std::string(rest)};
      for (std::string word; words >> word;) files.push_back(word);
    }
    if (files.size() > kMostFiles) break;
  }
  return files;
}

std::size_t occurrences(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + word.size())) ++count;
  return count;
}

// Files often name images where they lay on their maker's machine.
fs::path imageBeside(const fs::path& folder, std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  std::error_code failure;
  const fs::path there = folder / name, beside = folder / fs::path(name).filename();
  return !fs::exists(there, failure) && fs::exists(beside, failure) ? beside : there;
}

bool isMoved(const tinyobj::texture_option_t& option) {
  return option.scale[0] != 1.f || option.scale[1] != 1.f || option.origin_offset[0] != 0.f ||
         option.origin_offset[1] != 0.f;
}

Opacity opacityOf(const tinyobj::material_t& m, const fs::path& folder) {
  Opacity opacity{.factor = m.dissolve, .image = {}, .bytes = {}, .key = {}};
  if (!m.alpha_texname.empty()) {
    opacity.image = imageBeside(folder, m.alpha_texname);
    opacity.key = "map_d " + opacity.image.filename().string();
    opacity.moved = isMoved(m.alpha_texopt);
  } else if (!m.diffuse_texname.empty() && m.dissolve >= 0.5f) {
    // Many programs write a card's colours alone, which hold its outline in their alpha.
    const fs::path image = imageBeside(folder, m.diffuse_texname);
    std::error_code failure;
    if (!fs::is_regular_file(image, failure)) return opacity;
    opacity.image = image;
    opacity.key = "map_Kd " + image.filename().string();
    opacity.by_alpha = true;
    opacity.moved = isMoved(m.diffuse_texopt);
  }
  return opacity;
}

}  // namespace

ObjMaterials readObjMaterials(const fs::path& folder, const std::vector<std::string_view>& named) {
  ObjMaterials found;
  bool any = false;
  std::size_t count = 0;
  const std::vector<std::string> files = filesOf(named);
  for (const std::string& file : files) {
    std::error_code failure;
    if (!fs::is_regular_file(folder / file, failure) || fs::file_size(folder / file, failure) == 0) continue;
    const std::string text = readWhole(folder / file);
    any = true;
    count += occurrences(text, "newmtl");
    require(count <= kMostMaterials, shown((folder / file).string()) + ": number of materials", count, "at most 10000");
    std::istringstream in(text);
    std::map<std::string, int> index_of_name;
    std::vector<tinyobj::material_t> materials;
    std::string warning, error;
    tinyobj::LoadMtl(&index_of_name, &materials, &in, &warning, &error);
    for (const tinyobj::material_t& m : materials) {
      if (m.name.empty()) continue;
      found.colours[m.name] = {m.diffuse[0], m.diffuse[1], m.diffuse[2]};
      const Opacity opacity = opacityOf(m, folder);
      if (!opacity.image.empty() || !(opacity.factor >= opacity.least)) found.opacities[m.name] = opacity;
    }
  }
  if (!any && !files.empty()) found.missing = "its material file " + shown(files.front()) + " is missing";
  return found;
}

}  // namespace sunfleck::detail
