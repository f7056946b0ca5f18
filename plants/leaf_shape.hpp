#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sunfleck {

// What the outline of a leaf is like; widths are whatever the tree says.
enum class LeafShape {
  rectangle,    // the paper's, two triangles
  elliptic,     // apple, tupelo, sassafras
  ovate,        // widest below the middle, with a tip: cherry
  linear,       // lance-shaped: willow
  needle,       // with parallel sides: larch, fir
  cordate,      // heart-shaped: aspen
  deltoid,      // triangular: birch, cottonwood
  maple,        // five lobes
  palmate,      // seven deep lobes: Japanese maple
  rounded_oak,  // English oak
  spiky_oak,    // black oak
  blossom,      // five petals
};

// The right half of a leaf's outline, from its base (0, 0) to its tip (0, 1): x over half of the leaf's width [1], 0 ..
// 1, y over its length [1]. The left half mirrors it. Between base and tip y may leave [0, 1].
std::span<const glm::dvec2> halfOutline(LeafShape shape);

// Area of a leaf over its length times its width [1].
double areaShare(LeafShape shape);

std::string_view nameOf(LeafShape shape);
std::vector<LeafShape> leafShapes();

}  // namespace sunfleck
