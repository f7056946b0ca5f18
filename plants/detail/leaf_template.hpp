#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "core/leaf_patch.hpp"
#include "plants/weber_penn.hpp"

namespace sunfleck::detail {

// A leaf that is placed again and again. Its vertices: x across, over half of the leaf's width; y along and z off the
// face, over its length [1]; its petiole ends at the origin. Across, along and off the face are left-handed, as a
// stem's frame has them: seen from above, x points to the left.
struct LeafTemplate {
  std::vector<glm::dvec3> vertices;
  std::vector<glm::uvec3> triangles;  // counter-clockwise seen from above, +z
  std::vector<ImageCorners> corners;  // of each triangle in images of the flat leaf, seen from above with its tip up:
                                      // they end where its outline does
};

// The outline in triangles, folded by `fold` about the midrib and bent by `curl` along it [deg], in flat pieces of
// which none turns by more than 30 degrees against the next. A plain rectangle is the paper's: two triangles, its
// corners in turn from that of the base with the least x.
LeafTemplate leafTemplate(LeafShape shape, double width, double fold, double curl);

}  // namespace sunfleck::detail
