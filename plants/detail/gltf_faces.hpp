#pragma once

#include <tiny_gltf.h>

#include <cstddef>
#include <glm/mat4x4.hpp>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "plants/detail/gltf_materials.hpp"
#include "plants/detail/gltf_scene.hpp"
#include "plants/detail/named_triangles.hpp"

namespace sunfleck::detail {

// Gathers the triangles of a model's meshes, in the file's units and axes.
class GltfFaces {
 public:
  //   most  vertices, and triangles, that may come of it: instances multiply what a file holds
  GltfFaces(const tinygltf::Model& model, const std::vector<GltfMaterial>& materials, std::size_t most,
            const std::string& source);

  // Throws InvalidInput("<source>: ...") on what is broken.
  void add(const PlacedMesh& placed);

  NamedTriangles faces;
  std::vector<int> material_of_part;  // -1: none
  std::size_t skipped = 0;            // primitives of points and lines

 private:
  struct Corners {
    std::uint32_t first, first_texture;  // kNoTexture: none
    std::size_t count;
  };

  // Of accessors of positions and texture coordinates, and the material that moves these.
  using KnownCorners = std::map<std::tuple<int, int, int>, Corners>;
  void addPrimitive(const tinygltf::Primitive& primitive, const PlacedMesh& placed, KnownCorners& known);
  Corners addVertices(int positions, int texture, const GltfMaterial* material, const glm::dmat4& to_world);
  void addTriangles(const std::vector<std::uint32_t>& corners, int mode, const Corners& of, std::uint32_t part);
  std::uint32_t partOf(const tinygltf::Primitive& primitive, const PlacedMesh& placed);

  const tinygltf::Model& model_;
  const std::vector<GltfMaterial>& materials_;
  std::size_t most_;
  const std::string& source_;
  bool any_masks_;
  std::map<std::tuple<int, int, int>, std::uint32_t> part_of_;  // by material, mesh and node
};

}  // namespace sunfleck::detail
