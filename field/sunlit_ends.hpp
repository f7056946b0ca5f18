#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "field/elements.hpp"
#include "field/line_exchange.hpp"
#include "field/stand_sun.hpp"

namespace sunfleck {

// (F6) Where a sun's light falls on trees of a large stand that are turned alike: those ends of their kind's lines that
// lie where the sun's picture of such a tree shows the element that they end on. Of each tree those of them are lit
// whose pixels the sun reaches in the stand. A place whose pixel shows something else takes after a pixel next to it
// that shows the element or its leaf.
class SunlitEnds {
 public:
  //   rotation  that the trees are turned by [rad]
  //   picture   of such a tree, along `lines`
  SunlitEnds(const FieldElements& elements, const LineExchange& exchange, float rotation, const SunLines& lines,
             const TreePicture& picture);

  // What the lines of each side bring of direct light scattered once where it falls, as FieldProblem::scattered_once,
  // for light whose reflectance (of leaves), transmittance and reflectance of wood are 1: x, y and z.
  //   irradiance  direct light of each side [1]
  //   lit         pixels of the tree's picture that the sun reaches
  std::vector<glm::vec3> scatteredOnce(std::span<const float> irradiance, const LitPixels& lit) const;

 private:
  struct Lit {
    std::uint32_t side;   // that is lit
    std::uint32_t pixel;  // of the picture
  };
  // Of some elements, crossings that are lit; and what their sides see that is, by which side, kThrough added where it
  // sees the other side of the one that is lit.
  struct Block {
    std::vector<Lit> crossings, seen;
    std::vector<std::uint32_t> by;
  };
  static constexpr std::uint32_t kThrough = 1u << 31;

  const FieldElements& elements_;
  const LineExchange& exchange_;
  std::vector<Block> blocks_;
};

}  // namespace sunfleck
