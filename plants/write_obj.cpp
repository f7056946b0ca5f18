#include "plants/write_obj.hpp"

#include <fmt/format.h>

#include <iterator>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/require.hpp"
#include "core/whole_file.hpp"
#include "plants/detail/textured_vertices.hpp"

namespace sunfleck {
namespace {

constexpr std::string_view kMaterials =
    "newmtl leaf\nKd 0.09 0.27 0.05\nillum 1\n\nnewmtl wood\nKd 0.25 0.17 0.10\nillum 1\n";

void writeHead(std::string& text, std::string_view name) {
  fmt::format_to(std::back_inserter(text), "g {0}\nusemtl {0}\n", name);
}

void writeFace(std::string& text, const glm::uvec3& t) {
  fmt::format_to(std::back_inserter(text), "f {} {} {}\n", t.x + 1u, t.y + 1u, t.z + 1u);
}

// Writes the places in images that patches have, each once; those of each patch's corners, from 1.
std::vector<glm::uvec3> writeTexture(std::string& text, const std::vector<LeafPatch>& patches) {
  std::map<std::pair<float, float>, std::uint32_t> known;
  std::vector<glm::uvec3> of_patches;
  for (const LeafPatch& patch : patches) {
    glm::uvec3& numbers = of_patches.emplace_back();
    for (int c = 0; c < 3; ++c) {
      const glm::vec2& at = patch.corners[static_cast<std::size_t>(c)];
      const auto [number, is_new] = known.try_emplace({at.x, at.y}, static_cast<std::uint32_t>(known.size() + 1));
      if (is_new) fmt::format_to(std::back_inserter(text), "vt {:.9g} {:.9g}\n", at.x, at.y);
      numbers[c] = number->second;
    }
  }
  return of_patches;
}

}  // namespace

void writeObj(const std::filesystem::path& path, const TreeMesh& mesh) {
  require(path.extension() == ".obj", "output file", path.string(), "named with the extension .obj");
  requireWritable(path);
  std::filesystem::path materials = path;
  materials.replace_extension(".mtl");
  std::string text =
      fmt::format("# {} leaves; metres, z up\nmtllib {}\n", mesh.leaf_count, materials.filename().string());
  // Nine digits tell every float from its neighbours.
  for (const glm::vec3& v : mesh.vertices)
    fmt::format_to(std::back_inserter(text), "v {:.9g} {:.9g} {:.9g}\n", v.x, v.y, v.z);
  std::vector<glm::uvec3> texture;
  if (detail::anyPatch(mesh)) texture = writeTexture(text, mesh.patches);
  if (!mesh.leaf_triangles.empty()) writeHead(text, "leaf");
  for (std::size_t i = 0; i < mesh.leaf_triangles.size(); ++i) {
    const glm::uvec3& t = mesh.leaf_triangles[i];
    if (!patchOf(mesh, i)) {
      writeFace(text, t);
      continue;
    }
    const glm::uvec3& at = texture[mesh.patch_of_triangle[i]];
    fmt::format_to(std::back_inserter(text), "f {}/{} {}/{} {}/{}\n", t.x + 1u, at.x, t.y + 1u, at.y, t.z + 1u, at.z);
  }
  if (!mesh.wood_triangles.empty()) writeHead(text, "wood");
  for (const glm::uvec3& t : mesh.wood_triangles) writeFace(text, t);
  const bool had_materials = std::filesystem::exists(materials);
  writeWhole(materials, kMaterials);
  try {
    writeWhole(path, text);
  } catch (...) {  // the materials are nothing without the mesh
    if (!had_materials) std::filesystem::remove(materials);
    throw;
  }
}

}  // namespace sunfleck
