#include "plants/detail/obj.hpp"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <sstream>
#include <tuple>
#include <utility>

#include "core/require.hpp"
#include "plants/detail/input_file.hpp"
#include "plants/detail/leaf_or_wood.hpp"
#include "plants/detail/triangulate.hpp"

namespace sunfleck::detail {
namespace fs = std::filesystem;
namespace {

std::string trimmed(std::string text) {
  text.erase(text.find_last_not_of(" \t\r") + 1);
  text.erase(0, text.find_first_not_of(" \t"));
  return text;
}

// What tinyobjloader's callbacks gather. They give the names as the file has them; its other interface drops a material
// that no .mtl defines, and with it the faces' only name.
class ObjGatherer {
 public:
  std::vector<glm::vec3> vertices;
  std::vector<Part> parts;
  std::vector<std::vector<glm::uvec3>> triangles;  // of each part
  std::vector<std::vector<MaskCorners>>
      textured;  // texture coordinates of their corners, not a number if they lack some

  void read(std::istream& text, const std::string& source) {
    tinyobj::callback_t callbacks;
    callbacks.vertex_cb = [](void* self, float x, float y, float z, float) { of(self).vertices.emplace_back(x, y, z); };
    callbacks.texcoord_cb = [](void* self, float u, float v, float) { of(self).texture_.emplace_back(u, v); };
    callbacks.index_cb = [](void* self, tinyobj::index_t* corners, int count) {
      of(self).waiting_.push_back({of(self).currentPart(), of(self).corners_.size(), static_cast<std::size_t>(count)});
      for (int i = 0; i < count; ++i) of(self).addCorner(corners[i]);
    };
    callbacks.usemtl_cb = [](void* self, const char* name, int) {
      of(self).current_.material = trimmed(name);
      of(self).current_part_ = kNone;
    };
    callbacks.group_cb = [](void* self, const char** names, int count) {
      of(self).current_.groups.assign(names, names + count);
      of(self).current_part_ = kNone;
    };
    callbacks.object_cb = [](void* self, const char* name) {
      of(self).current_.object = trimmed(name);
      of(self).current_part_ = kNone;
    };
    std::string warning, error;
    tinyobj::LoadObjWithCallback(text, callbacks, this, nullptr, &warning, &error);
    // A face may come before its vertices, so polygons are cut when all are known.
    triangles.resize(parts.size());
    textured.resize(parts.size());
    // checkObj has looked at every index; this guards memory should the two ever read a line differently.
    for (const std::uint32_t corner : corners_)
      require(corner < vertices.size(), source + ": vertex index", std::int64_t{corner} + 1,
              "at most the number of vertices, " + std::to_string(vertices.size()));
    for (const Face& face : waiting_) {
      const std::span<const std::uint32_t> corners = std::span(corners_).subspan(face.first, face.count);
      std::vector<glm::uvec3>& cut = triangles[face.part];
      const std::size_t before = cut.size();
      triangulate(vertices, corners, cut);
      for (std::size_t i = before; i < cut.size(); ++i) {
        MaskCorners& of_corners = textured[face.part].emplace_back();
        for (int c = 0; c < 3; ++c) {
          const auto at = std::find(corners.begin(), corners.end(), cut[i][c]) - corners.begin();
          of_corners[static_cast<std::size_t>(c)] =
              textureOf(texture_corners_[face.first + static_cast<std::size_t>(at)]);
        }
      }
    }
  }

 private:
  static constexpr std::size_t kNone = ~std::size_t{0};
  static constexpr std::uint32_t kNoTexture = ~0u;
  struct Face {
    std::size_t part, first, count;
  };

  static ObjGatherer& of(void* self) { return *static_cast<ObjGatherer*>(self); }

  // Indices count from 1, negative ones back from the last; 0 stands for none.
  void addCorner(const tinyobj::index_t& corner) {
    const auto from0 = [](int index, std::size_t count) {
      return static_cast<std::uint32_t>(index > 0 ? index - 1 : static_cast<int>(count) + index);
    };
    corners_.push_back(from0(corner.vertex_index, vertices.size()));
    texture_corners_.push_back(corner.texcoord_index == 0 ? kNoTexture : from0(corner.texcoord_index, texture_.size()));
  }

  glm::vec2 textureOf(std::uint32_t index) const {
    return index < texture_.size() ? texture_[index] : glm::vec2(std::numeric_limits<float>::quiet_NaN());
  }

  std::size_t currentPart() {
    if (current_part_ == kNone) {
      const auto [known, is_new] =
          part_of_names_.try_emplace({current_.material, current_.groups, current_.object}, parts.size());
      if (is_new) parts.push_back(current_);
      current_part_ = known->second;
    }
    return current_part_;
  }

  Part current_;
  std::size_t current_part_ = kNone;
  std::map<std::tuple<std::string, std::vector<std::string>, std::string>, std::size_t> part_of_names_;
  std::vector<Face> waiting_;
  std::vector<std::uint32_t> corners_, texture_corners_;
  std::vector<glm::vec2> texture_;
};

// Names of material files in the order of the text; one may hold blanks, so the whole rest of a line is tried as well.
std::vector<std::string> materialFiles(const std::string& text) {
  std::vector<std::string> names;
  for (std::size_t at = text.find("mtllib"); at != std::string::npos; at = text.find("mtllib", at + 6)) {
    const std::size_t line_start = at == 0 ? 0 : text.find_last_of("\r\n", at - 1) + 1;
    if (text.find_first_not_of(" \t", line_start) != at) continue;
    const std::string rest = trimmed(text.substr(at + 6, text.find_first_of("\r\n", at) - at - 6));
    names.push_back(rest);
    if (rest.find(' ') == std::string::npos) continue;
    std::istringstream words(rest);
    for (std::string word; words >> word;) names.push_back(word);
  }
  return names;
}

// How much of a material is there [1].
struct Opacity {
  float dissolve = 1.f;  // of all of it
  fs::path image;        // of each place; none if empty
  bool moved = false;    // whether the image is to be moved or scaled on the face
};

struct Materials {
  std::map<std::string, glm::vec3> colours;
  std::map<std::string, Opacity> opacities;  // of those that are not opaque all over
  std::string missing;                       // a remark on a material file that is not there
};

Materials readMaterials(const fs::path& folder, const std::vector<std::string>& files) {
  Materials found;
  bool any = false;
  for (const std::string& file : files) {
    std::error_code failure;
    if (!fs::is_regular_file(folder / file, failure)) continue;
    std::ifstream in(folder / file);
    if (!in) continue;
    any = true;
    std::map<std::string, int> index_of_name;
    std::vector<tinyobj::material_t> materials;
    std::string warning, error;
    tinyobj::LoadMtl(&index_of_name, &materials, &in, &warning, &error);
    for (const tinyobj::material_t& m : materials) {
      if (m.name.empty()) continue;
      found.colours[m.name] = {m.diffuse[0], m.diffuse[1], m.diffuse[2]};
      std::string name = m.alpha_texname;
      std::replace(name.begin(), name.end(), '\\', '/');
      const auto& [u, v] = std::tie(m.alpha_texopt.scale[0], m.alpha_texopt.scale[1]);
      const auto& [right, up] = std::tie(m.alpha_texopt.origin_offset[0], m.alpha_texopt.origin_offset[1]);
      if (!name.empty() || !(m.dissolve >= 0.5f))
        found.opacities[m.name] = {.dissolve = m.dissolve,
                                   .image = name.empty() ? fs::path() : folder / name,
                                   .moved = u != 1.f || v != 1.f || right != 0.f || up != 0.f};
    }
  }
  if (!any && !files.empty()) found.missing = "its material file " + shown(files.front()) + " is missing";
  return found;
}

// The masks of a mesh, each read once.
class Masks {
 public:
  Masks(const std::string& source, const ImageReader& read_image) : source_(source), read_image_(read_image) {}

  std::uint32_t numberOf(const Opacity& opacity, TreeMesh& mesh) {
    const auto [known, is_new] =
        numbers_.try_emplace({opacity.image.string(), opacity.dissolve}, static_cast<std::uint32_t>(mesh.masks.size()));
    if (is_new) mesh.masks.push_back(std::make_shared<const LeafMask>(read(opacity)));
    return known->second;
  }

 private:
  LeafMask read(const Opacity& opacity) const {
    if (!read_image_)
      throw InvalidInput(source_ + ": has leaves that a mask cuts out (map_d " +
                         shown(opacity.image.filename().string()) + "): sunfleck trace alone can take them");
    if (opacity.moved)
      throw InvalidInput(source_ + ": map_d " + shown(opacity.image.filename().string()) +
                         ": must be without -s and -o, which move the mask");
    const Image image = read_image_(opacity.image);
    const std::size_t channels = image.channels.size(), pixels = image.values.size() / channels;
    const auto alpha =
        static_cast<std::size_t>(std::find(image.channels.begin(), image.channels.end(), "A") - image.channels.begin());
    const auto isOne = [&](std::size_t pixel) { return image.values[pixel * channels + alpha] == 1.f; };
    bool by_alpha = false;
    for (std::size_t pixel = 0; alpha < channels && pixel < pixels && !by_alpha; ++pixel) by_alpha = !isOne(pixel);
    LeafMask mask{.width = image.width, .height = image.height, .opaque = {}};
    const std::size_t colours = std::min<std::size_t>(alpha, channels >= 3 ? 3 : 1);
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
      const float* const values = image.values.data() + pixel * channels;
      const float brightness =
          std::accumulate(values, values + colours, 0.f) / static_cast<float>(std::max<std::size_t>(colours, 1));
      mask.opaque.push_back(opacity.dissolve * (by_alpha ? values[alpha] : brightness) >= 0.5f);
    }
    return mask;
  }

  const std::string& source_;
  const ImageReader& read_image_;
  std::map<std::pair<std::string, float>, std::uint32_t> numbers_;
};

}  // namespace

ImportedTree readObj(const fs::path& path, std::string text, const ImportRules& rules, const ImageReader& read_image) {
  const std::string source = shown(path.string());
  checkObj(text, source);
  const Materials materials = readMaterials(path.parent_path(), materialFiles(text));
  std::istringstream stream(std::move(text));
  ObjGatherer gathered;
  gathered.read(stream, source);
  for (Part& part : gathered.parts)
    if (const auto known = materials.colours.find(part.material); known != materials.colours.end())
      part.colour = known->second;
  const Verdict verdict = tellApart(gathered.parts, rules, source, materials.missing);
  ImportedTree tree{.mesh = {}, .dropped = {}, .how = verdict.how};
  tree.mesh.vertices = std::move(gathered.vertices);
  Masks masks(source, read_image);
  std::size_t left_out = 0;
  for (std::size_t i = 0; i < verdict.kinds.size(); ++i) {
    const std::vector<glm::uvec3>& triangles = gathered.triangles[i];
    if (verdict.kinds[i] == Kind::wood) {
      tree.mesh.wood_triangles.insert(tree.mesh.wood_triangles.end(), triangles.begin(), triangles.end());
      continue;
    }
    const auto opacity = materials.opacities.find(gathered.parts[i].material);
    if (opacity != materials.opacities.end() && opacity->second.image.empty()) {
      left_out += triangles.size();
      continue;
    }
    tree.mesh.leaf_triangles.insert(tree.mesh.leaf_triangles.end(), triangles.begin(), triangles.end());
    const std::uint32_t mask =
        opacity == materials.opacities.end() ? LeafCut::kWhole : masks.numberOf(opacity->second, tree.mesh);
    for (const MaskCorners& corners : gathered.textured[i]) tree.mesh.leaf_cuts.push_back({mask, corners});
  }
  if (tree.mesh.masks.empty())
    tree.mesh.leaf_cuts.clear();
  else
    tree.how += "; leaves are cut out by masks (map_d)";
  if (left_out > 0) tree.how += "; left out " + std::to_string(left_out) + " leaf triangles of transparent materials";
  return tree;
}

}  // namespace sunfleck::detail
