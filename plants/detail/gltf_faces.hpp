#pragma once

#include <tiny_gltf.h>

#include <cstddef>
#include <glm/mat4x4.hpp>
#include <map>
#include <string>
#include <tuple>
#include <utility>
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
    std::uint32_t first;
    std::size_t count;
    std::uint32_t first_texture = NamedTriangles::kNoTexture;
  };

  using KnownCorners = std::map<int, Corners>;  // of accessors of positions
  void addPrimitive(const tinygltf::Primitive& primitive, const PlacedMesh& placed, KnownCorners& known);
  Corners addVertices(int positions, const glm::dmat4& to_world);
  std::uint32_t textureOf(const tinygltf::Primitive& primitive, std::size_t vertices);
  void addTriangles(const std::vector<std::uint32_t>& corners, int mode, bool mirrored, const Corners& of,
                    std::uint32_t part);
  std::uint32_t partOf(const tinygltf::Primitive& primitive, const PlacedMesh& placed);

  const tinygltf::Model& model_;
  const std::vector<GltfMaterial>& materials_;
  std::size_t most_;
  const std::string& source_;
  std::map<std::pair<int, int>, std::uint32_t> first_texture_of_;  // by accessor, and material that moves it or -1
  std::map<std::tuple<int, int, int>, std::uint32_t> part_of_;     // by material, mesh and node
};

}  // namespace sunfleck::detail
