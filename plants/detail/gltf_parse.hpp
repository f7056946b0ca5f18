#pragma once

#include <tiny_gltf.h>

#include <filesystem>
#include <string>

namespace sunfleck::detail {

// The model in the bytes of a .gltf or .glb with the buffers beside it; images beside it are not read, those within are
// kept as they stand. Throws InvalidInput("<source>: ...") on what is broken, and on JSON of more than 200,000 objects
// or 3 million values, which would fill the memory.
tinygltf::Model parseGltf(const std::filesystem::path& path, const std::string& bytes, const std::string& source);

}  // namespace sunfleck::detail
