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

struct PartWalk {
  std::size_t lanes;  // lines that are walked along side by side
  // Writes for each line where it enters and leaves the box, the former not below the latter where it misses it; and
  // step by step, a row of lanes for each, the part it is in and where it leaves that. Steps are as many as the longest
  // line needs and mostSteps() at most. A line that grazes the box's rim may by rounding go on beside it for a
  // millionth of a part: by one part along each axis.
  //   from   where depth is 0 [m]: x of all lanes, then y, then z
  //   along  unit vector
  //   begin, last, ends  depths [m]
  // Returns the number of steps.
  std::size_t (*walk)(const PartGrid& grid, const glm::vec3& along, const float* from, float* begin, float* last,
                      float* ends, std::int32_t* parts);
};

PartWalk partWalk();

}  // namespace sunfleck::detail
