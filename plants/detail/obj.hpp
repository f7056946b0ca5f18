#pragma once

#include <filesystem>
#include <string>

#include "plants/import.hpp"

namespace sunfleck::detail {

// Refuses what tinyobjloader takes silently: it reads "nan" and missing numbers as 0 and leaves indices unchecked.
// Throws InvalidInput("<source> line <n>: ..."). `text` holds at least one face afterwards.
void checkObj(const std::string& text, const std::string& source);

// Reads an OBJ in the file's units and axes. The mesh is not finished.
ImportedTree readObj(const std::filesystem::path& path, std::string text, const ImportRules& rules,
                     const ImageReader& read_image);

}  // namespace sunfleck::detail
