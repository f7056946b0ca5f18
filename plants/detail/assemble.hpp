#pragma once

#include <string>

#include "plants/detail/named_triangles.hpp"
#include "plants/detail/part_opacity.hpp"
#include "plants/import.hpp"

namespace sunfleck::detail {

// A tree of what a file holds: leaves and wood as told, cards with their masks, which are read. The mesh is not
// finished. Throws InvalidInput("<source>: ...").
ImportedTree assemble(NamedTriangles faces, const Verdict& verdict, const ImportRules& rules,
                      const ImageReader& read_image, const std::string& source);

// Makes a tree of a file's triangles usable: in metres with z up, leaves told apart, cards cut as the rules say,
// `finish`ed.
void complete(ImportedTree& tree, const ImportRules& rules, bool format_y_up, const std::string& source);

}  // namespace sunfleck::detail
