#pragma once

#include <deque>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "plants/detail/named_triangles.hpp"
#include "plants/import.hpp"

namespace sunfleck::detail {

// An OBJ's geometry, whose names refer to its text and to `joined`.
struct ObjFile {
  NamedTriangles faces;
  std::deque<std::string> joined;                // lines that backslashes continue
  std::vector<std::string_view> material_files;  // what follows each mtllib
};

// Reads the text of an OBJ. Polygons are cut into triangles. Throws InvalidInput("<source> line <n>: ...") on a number
// or an index that is none, an index out of range, a coordinate that is not finite, a face of fewer than 3 or more than
// 1000 corners, a zero byte, and on a file without faces.
ObjFile parseObj(std::string_view text, const std::string& source);

// Reads an OBJ in the file's units and axes. The mesh is not finished.
ImportedTree readObj(const std::filesystem::path& path, std::string_view text, const ImportRules& rules,
                     const ImageReader& read_image);

}  // namespace sunfleck::detail
