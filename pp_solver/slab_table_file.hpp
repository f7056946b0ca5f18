#pragma once

#include <filesystem>

#include "pp_solver/slab_table.hpp"

namespace sunfleck::pp {

// A table as a file, whole or not at all: magic "SUNFSLAB", version, byte order, length of the file; the medium, the
// axes, the errors and the sizes; the values; a CRC-32 of all before it. Little-endian, as in memory. Throws
// InvalidInput when the place cannot be written.
void writeSlabTable(const std::filesystem::path& path, const SlabTable& table);

// Reads it back to the same bits. Sizes are checked against the file's length before memory is taken for them; a file
// that is damaged, of another version or no table at all throws InvalidInput, one line with the file's name.
SlabTable readSlabTable(const std::filesystem::path& path);

}  // namespace sunfleck::pp
