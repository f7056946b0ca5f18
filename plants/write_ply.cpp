#include "plants/write_ply.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <string>

#include "core/whole_file.hpp"

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
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment {} leaves; metres, z up; wood: 0 leaf, 1 wood\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\nelement face {}\nproperty list uchar uint vertex_indices\n"
      "property uchar wood\nend_header\n",
      mesh.leaf_count, mesh.vertices.size(), mesh.leaf_triangles.size() + mesh.wood_triangles.size());
  bytes.reserve(bytes.size() + 12 * mesh.vertices.size() +
                14 * (mesh.leaf_triangles.size() + mesh.wood_triangles.size()));
  for (const glm::vec3& v : mesh.vertices)
    for (int axis = 0; axis < 3; ++axis) put(bytes, std::bit_cast<std::uint32_t>(v[axis]));
  putFaces(bytes, mesh.leaf_triangles, false);
  putFaces(bytes, mesh.wood_triangles, true);
  writeWhole(path, bytes);
}

}  // namespace sunfleck
