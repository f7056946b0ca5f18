#pragma once

#include <cstddef>
#include <filesystem>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "grid/density_grid.hpp"

namespace sunfleck {

// A grid of numbers that are known in some cells.
struct CellValues {
  std::string name, description, unit;
  std::vector<glm::ivec3> cells;
  std::vector<float> values;  // of each cell
};

// Writes grids of common cells as a .vdb file, whole or not at all, for other programs: fog volumes with what they hold
// in their metadata. Throws InvalidInput when it cannot be written.
//   corner     low corner of cell (0, 0, 0) [m]
//   cell_size  [m]
void writeCellValues(const std::filesystem::path& file, std::span<const CellValues> grids, const glm::dvec3& corner,
                     double cell_size, const GridSource& source);

}  // namespace sunfleck
