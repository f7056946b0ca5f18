#pragma once

#include <filesystem>
#include <span>

#include "core/stand.hpp"
#include "core/tree_mesh.hpp"

namespace sunfleck {

// Writes trees as glTF 2.0: .glb, or .gltf with its data within. Metres, y up as glTF has it: x is x, y is z, z is -y.
// Each kind is one mesh with the materials `leaf`, two-sided and with KHR_materials_diffuse_transmission, and `wood`;
// several trees of a kind are one node with EXT_mesh_gpu_instancing. Colours are for display. importTree reads one tree
// back, bit for bit. Whole or not at all. Throws InvalidInput when the file cannot be written, has another extension or
// would hold more than 2 GiB, and on a periodic stand.
void writeGltf(const std::filesystem::path& path, std::span<const TreeMesh* const> kinds, const Stand& stand);
void writeGltf(const std::filesystem::path& path, const TreeMesh& mesh);  // one tree, at the origin

}  // namespace sunfleck
