#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/tree_mesh.hpp"

namespace sunfleck::detail {

// What the header of a PLY file declares (G. Turk 1994, "The PLY Polygon File Format").
struct PlyHeader {
  enum class Format { ascii, little_endian, big_endian };
  enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
  struct Property {
    std::string name;
    Type type;
    std::optional<Type> count_type;  // a list of `type`, with its length before it
  };
  struct Element {
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties;
  };

  Format format = Format::ascii;
  std::vector<Element> elements;
  std::size_t body = 0;  // where the data begin [byte]
  std::size_t line = 1;  // and on which line
};

std::size_t sizeOf(PlyHeader::Type type);  // [byte]

// Throws InvalidInput("<source> line <n>: ...") on a header that is not PLY's.
PlyHeader readPlyHeader(std::string_view text, const std::string& source);

// Reads a PLY file's vertices and faces in the file's units and axes: leaves, and wood where a property `wood` says so.
// The mesh is not finished. No memory is set aside for declared counts that the file is too short to hold. Throws
// InvalidInput("<source>: ...").
TreeMesh readPly(std::string_view text, const std::string& source);

}  // namespace sunfleck::detail
