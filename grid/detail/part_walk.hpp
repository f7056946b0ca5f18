#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>

// (D4) Which parts of space lines pass, compiled for several instruction sets; partWalk() is the best that this machine
// has.
namespace sunfleck::detail {

// Cubic parts of a box. Part (x, y, z) is number (z * size.y + y) * size.x + x.
struct PartGrid {
  glm::vec3 low, high;  // of the box [m]
  float side;           // of a part [m]
  glm::ivec3 size;      // [part]
  std::size_t mostSteps() const { return static_cast<std::size_t>(size.x + size.y + size.z) + 4; }
};

// What lines pass, side by side in lanes: for each line a number, or step by step rows of lanes with room for
// mostSteps().
struct PassedParts {
  float* begin;         // where each enters the box [m]
  std::int32_t* count;  // of the parts it passes; 0: none
  std::int32_t* part;
  float *end, *length;  // where each leaves the part, and its way in it [m]
};

struct PartWalk {
  std::size_t lanes;
  // A line that grazes the box's rim may by rounding go on beside it for a millionth of a part: by one part along each
  // axis.
  //   from   where depth is 0 [m]: x of all lanes, then y, then z
  //   along  unit vector
  void (*walk)(const PartGrid& grid, const glm::vec3& along, const float* from, const PassedParts& passed);
};

PartWalk partWalk();

}  // namespace sunfleck::detail
