#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string_view>

namespace sunfleck {

// Where and how a grid of floats lies in a .vdb file.
struct VdbFloatGrid {
  std::uint32_t file_version = 0;
  std::uint32_t library_major = 0, library_minor = 0;
  std::uint32_t compression = 0;  // OpenVDB's flags
  bool half = false;              // values are kept in 16 bits
  glm::dvec3 scale{1.};           // distance between cell centres [m]
  glm::dvec3 translation{0.};     // centre of cell (0, 0, 0) [m]
  std::size_t topology = 0;       // [byte] from the start of the file
  std::size_t values = 0;         // [byte]
  double memory = 0.;             // that OpenVDB takes to read the tree [byte]
};

// Walks the bytes of a .vdb file along the one grid called `name` and checks that every size, count and offset in it
// holds within the file, so that OpenVDB 10, which trusts them, may read the grid's tree: what it allocates is then
// known, some 35 times the length of the file at most, and nothing is read or written out of bounds. Formats 222 to
// 224, as OpenVDB 2 and later write. Nothing when the file holds no grid of that name. Throws InvalidInput("<what is
// wrong>"), which the caller completes with the file's name.
std::optional<VdbFloatGrid> findFloatGrid(std::string_view bytes, std::string_view name);

}  // namespace sunfleck
