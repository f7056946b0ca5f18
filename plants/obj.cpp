#include "plants/detail/obj.hpp"

#include <tiny_obj_loader.h>

#include <cstdint>
#include <fstream>
#include <map>
#include <sstream>
#include <tuple>

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

  void read(std::istream& text, const std::string& source) {
    tinyobj::callback_t callbacks;
    callbacks.vertex_cb = [](void* self, float x, float y, float z, float) { of(self).vertices.emplace_back(x, y, z); };
    callbacks.index_cb = [](void* self, tinyobj::index_t* corners, int count) {
      of(self).waiting_.push_back({of(self).currentPart(), of(self).corners_.size(), static_cast<std::size_t>(count)});
      for (int i = 0; i < count; ++i) of(self).addCorner(corners[i].vertex_index);
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
    // checkObj has looked at every index; this guards memory should the two ever read a line differently.
    for (const std::uint32_t corner : corners_)
      require(corner < vertices.size(), source + ": vertex index", std::int64_t{corner} + 1,
              "at most the number of vertices, " + std::to_string(vertices.size()));
    for (const Face& face : waiting_)
      triangulate(vertices, std::span(corners_).subspan(face.first, face.count), triangles[face.part]);
  }

 private:
  static constexpr std::size_t kNone = ~std::size_t{0};
  struct Face {
    std::size_t part, first, count;
  };

  static ObjGatherer& of(void* self) { return *static_cast<ObjGatherer*>(self); }

  void addCorner(int index) {
    const auto count = static_cast<int>(vertices.size());
    corners_.push_back(static_cast<std::uint32_t>(index > 0 ? index - 1 : count + index));
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
  std::vector<std::uint32_t> corners_;
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

struct Materials {
  std::map<std::string, glm::vec3> colours;
  std::string missing;  // a remark on a material file that is not there
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
    for (const tinyobj::material_t& m : materials)
      if (!m.name.empty()) found.colours[m.name] = {m.diffuse[0], m.diffuse[1], m.diffuse[2]};
  }
  if (!any && !files.empty()) found.missing = "its material file " + shown(files.front()) + " is missing";
  return found;
}

}  // namespace

ImportedTree readObj(const fs::path& path, std::string text, const ImportRules& rules) {
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
  for (std::size_t i = 0; i < verdict.kinds.size(); ++i) {
    auto& kind = verdict.kinds[i] == Kind::leaf ? tree.mesh.leaf_triangles : tree.mesh.wood_triangles;
    kind.insert(kind.end(), gathered.triangles[i].begin(), gathered.triangles[i].end());
  }
  return tree;
}

}  // namespace sunfleck::detail
