#pragma once

#include <string>
#include <string_view>

#include "core/tree_mesh.hpp"

namespace sunfleck::detail {

// Reads a list of flat round leaves as RAMI has them, one a line: radius x y z nx ny nz, apart by blanks or tabs, in
// the file's units and axes. Empty lines and what follows a # say nothing. A leaf becomes a regular polygon of 12
// corners with the disc's area, whose normal need not be of length 1. The mesh is not finished. Throws
// InvalidInput("<source> line <n>: ...").
TreeMesh readLeafList(std::string_view text, const std::string& source);

}  // namespace sunfleck::detail
