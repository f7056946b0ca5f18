#pragma once

#include <cstdint>
#include <glm/common.hpp>
#include <glm/gtc/type_precision.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "core/directions.hpp"
#include "core/progress.hpp"
#include "core/tree_mesh.hpp"
#include "field/elements.hpp"

namespace sunfleck {

// How many lines exchange light.
struct ExchangeEffort {
  int axes = 40;  // directions of lines; light goes both ways [1]
  // Of a leaf of mean area by the lines of one direction, in the mean; and of an element half as many at least [1].
  float crossings = 2.f;
};

// Places in a stand, to 1/65536 of its box or period.
class PlaceCode {
 public:
  PlaceCode() = default;
  PlaceCode(const TreeMesh& mesh, const std::optional<glm::vec2>& period);
  glm::u16vec3 code(const glm::vec3& place) const {
    glm::ivec3 whole(glm::floor((place - low_) * per_metre_));
    whole.z = glm::clamp(whole.z, 0, 65'535);
    // Beyond the end of a period the number overflows, as it should.
    if (!periodic_) whole = glm::clamp(whole, 0, 65'535);
    return glm::u16vec3(whole);
  }
  glm::vec3 place(const glm::u16vec3& code) const { return low_ + (glm::vec3(code) + 0.5f) / per_metre_; }

 private:
  glm::vec3 low_{0.f}, per_metre_{1.f};
  bool periodic_ = false;
};

// (F2) Who sees whom: parallel lines in directions spread evenly over the sphere, as many per area in each, and the
// elements that each line crosses, in order. Neighbours on a line see each other, from the sides that face each other;
// the first and the last on a line see the outside. All lines count alike, so that what one sends to another over a
// line comes back over it as well: exchange is reciprocal, no light is lost, and even light all around stays even,
// exactly. It knows nothing of light and optics.
struct LineExchange {
  // Of side 2 element (front) or 2 element + 1 (back): the sides it sees, one for each of its lines that meets
  // something, sees[first[side]] up to sees[first[side + 1]].
  std::vector<std::uint64_t> first;
  std::vector<std::uint32_t> sees;
  std::vector<std::uint32_t> seen_at;  // the crossing of the element that it sees there, as sees
  std::vector<std::uint32_t> lines;    // of each element: those that cross it; as many come to either side
  // Crossings of element i, first_crossing[i] up to first_crossing[i + 1], and where they are on it; see `places`.
  std::vector<std::uint32_t> first_crossing;
  std::vector<glm::u16vec3> crossed_at;
  // Of each side, the directions in which light comes to it from outside, as first and sees.
  std::vector<std::uint64_t> first_outside;
  std::vector<std::uint16_t> outside;
  std::vector<std::uint32_t> open_at;  // the crossing of its own element, as outside
  std::vector<std::uint32_t> below;    // of each side, those of them that rise: from the ground
  PlaceCode places;
  std::vector<Direction> directions;      // in which light travels: along each axis, then against it
  std::vector<std::uint64_t> free_lines;  // with a period: of each axis, lines that meet nothing
  std::uint64_t all_lines = 0;            // with a period: of all axes
  double line_power = 0.;                 // that a line carries per radiance: its area times its solid angle [m^2 sr]

  std::size_t sides() const { return first.size() - 1; }
  std::size_t memoryBytes() const;
};

//   period  side lengths of the repeated rectangle [m]; none: the stand is alone
// Throws InvalidInput where the memory that it takes is more than there is, and std::runtime_error("interrupted") when
// `progress`, told after each axis, ends it.
LineExchange lineExchange(const TreeMesh& mesh, const FieldElements& elements, const std::optional<glm::vec2>& period,
                          const ExchangeEffort& effort = {}, const Progress& progress = {});

}  // namespace sunfleck
