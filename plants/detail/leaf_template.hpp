#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "plants/weber_penn.hpp"

namespace sunfleck::detail {

// A leaf that is placed again and again. Its vertices: x across, over half of the leaf's width; y along and z off the
// face, over its length [1]; its petiole ends at the origin.
struct LeafTemplate {
  std::vector<glm::dvec3> vertices;
  std::vector<glm::uvec3> triangles;
};

// The outline in triangles, folded by `fold` about the midrib and bent by `curl` along it [deg], in flat pieces of
// which none turns by more than 30 degrees against the next. A plain rectangle is the paper's: two triangles, the
// corners in turn from the left one of the base.
LeafTemplate leafTemplate(LeafShape shape, double width, double fold, double curl);

}  // namespace sunfleck::detail
