#pragma once

#include <openvdb/openvdb.h>

#include <filesystem>

namespace sunfleck {

// Writes grids, all of floats, as OpenVDB keeps them, and looks whether they arrived. Throws std::exception when not.
void writeVdb(const openvdb::GridCPtrVec& grids, const std::filesystem::path& file);

}  // namespace sunfleck
