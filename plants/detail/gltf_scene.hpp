#pragma once

#include <tiny_gltf.h>

#include <glm/mat4x4.hpp>
#include <string>
#include <vector>

namespace sunfleck::detail {

// A mesh where a node puts it.
struct PlacedMesh {
  int mesh, node;  // of the model's
  glm::dmat4 to_world;
};

// The meshes of the model's scene, instances each for itself, in the order of its nodes. Throws
// InvalidInput("<source>: ...") on nodes that are below several others or below themselves, on broken accessors and on
// more than 2 million placements.
std::vector<PlacedMesh> placedMeshes(const tinygltf::Model& model, const std::string& source);

}  // namespace sunfleck::detail
