#pragma once

#include <filesystem>
#include <string>

#include "plants/import.hpp"

namespace sunfleck::detail {

// Reads a .gltf or .glb file's triangles through all nodes of its scene and their instances (EXT_mesh_gpu_instancing),
// in metres with y up. The mesh is not finished. Buffers beside the file are read, images are not. Throws
// InvalidInput("<source>: ...").
ImportedTree readGltf(const std::filesystem::path& path, const std::string& bytes, const ImportRules& rules);

}  // namespace sunfleck::detail
