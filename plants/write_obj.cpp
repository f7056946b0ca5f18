#include "plants/write_obj.hpp"

#include <fmt/format.h>

#include <iterator>
#include <string>
#include <string_view>

#include "core/require.hpp"
#include "core/whole_file.hpp"

namespace sunfleck {
namespace {

constexpr std::string_view kMaterials =
    "newmtl leaf\nKd 0.09 0.27 0.05\nillum 1\n\nnewmtl wood\nKd 0.25 0.17 0.10\nillum 1\n";

void writePart(std::string& text, std::string_view name, const std::vector<glm::uvec3>& triangles) {
  if (triangles.empty()) return;
  fmt::format_to(std::back_inserter(text), "g {0}\nusemtl {0}\n", name);
  for (const glm::uvec3& t : triangles)
    fmt::format_to(std::back_inserter(text), "f {} {} {}\n", t.x + 1u, t.y + 1u, t.z + 1u);
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
  writePart(text, "leaf", mesh.leaf_triangles);
  writePart(text, "wood", mesh.wood_triangles);
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
