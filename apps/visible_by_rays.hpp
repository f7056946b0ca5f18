#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "render/gl/drawn_stand.hpp"
#include "render/gl/view.hpp"
#include "render/reference/ray_scene.hpp"

namespace sunfleck::apps {

// What is seen of a drawn stand, found by rays on the processor (R32): the first pass of pictures of thousands of trees
// where there is no graphics card.
class VisibleByRays {
 public:
  explicit VisibleByRays(const gl::DrawnStand& stand);

  // Pairs of drawn tree and triangle in the pixels of a view into a target of that size, rows from bottom to top. All
  // leaves are seen as they are, whatever level of detail the view asks for. Works in parallel.
  std::vector<glm::uvec2> operator()(const gl::View& view, const glm::ivec2& size) const;

 private:
  std::optional<RayScene> scene_;  // none where nothing stands
};

}  // namespace sunfleck::apps
