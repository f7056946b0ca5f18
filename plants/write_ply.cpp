#include "plants/write_ply.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <string>

#include "core/whole_file.hpp"
#include "plants/detail/textured_vertices.hpp"

namespace sunfleck {
namespace {

void put(std::string& bytes, std::uint32_t value) {
  for (int byte = 0; byte < 4; ++byte) bytes.push_back(static_cast<char>((value >> (8 * byte)) & 0xffu));
}

void putFaces(std::string& bytes, const std::vector<glm::uvec3>& triangles, bool wood) {
  for (const glm::uvec3& t : triangles) {
    bytes.push_back(3);
    for (int corner = 0; corner < 3; ++corner) put(bytes, t[corner]);
    bytes.push_back(wood ? 1 : 0);
  }
}

}  // namespace

void writePly(const std::filesystem::path& path, const TreeMesh& mesh) {
  requireNamed(path, ".ply");
  const detail::TexturedVertices corners = detail::texturedVertices(mesh);
  const bool textured = !corners.texture.empty();
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment {} leaves; metres, z up; wood: 0 leaf, 1 wood\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n{}element face {}\nproperty list uchar uint "
      "vertex_indices\n"
      "property uchar wood\nend_header\n",
      mesh.leaf_count, corners.vertices.size(), textured ? "property float s\nproperty float t\n" : "",
      mesh.leaf_triangles.size() + mesh.wood_triangles.size());
  bytes.reserve(bytes.size() + (textured ? 20 : 12) * corners.vertices.size() +
                14 * (mesh.leaf_triangles.size() + mesh.wood_triangles.size()));
  for (std::size_t i = 0; i < corners.vertices.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) put(bytes, std::bit_cast<std::uint32_t>(corners.vertices[i][axis]));
    for (int axis = 0; textured && axis < 2; ++axis) put(bytes, std::bit_cast<std::uint32_t>(corners.texture[i][axis]));
  }
  putFaces(bytes, corners.leaf_triangles, false);
  putFaces(bytes, mesh.wood_triangles, true);
  writeWhole(path, bytes);
}

}  // namespace sunfleck
