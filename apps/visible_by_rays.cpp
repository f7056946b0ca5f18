#include "apps/visible_by_rays.hpp"

#include "render/reference/visible_surfaces.hpp"

namespace sunfleck::apps {
namespace {

PixelRays raysOf(const gl::View& view, const glm::ivec2& size) {
  const Camera& camera = view.camera;
  const PixelSteps steps = pixelSteps(camera);
  const glm::vec2 low(view.low);
  PixelRays rays{.corner = steps.lower_left + low.x * steps.right + low.y * steps.up,
                 .right_step = steps.right,
                 .down_step = steps.up,  // rows from bottom to top
                 .sight = viewAxes(camera).along,
                 .width = size.x,
                 .height = size.y,
                 .eye = std::nullopt};
  if (camera.perspective())
    rays.eye = eyeOf(camera);
  else
    rays.corner += camera.target;
  return rays;
}

}  // namespace

VisibleByRays::VisibleByRays(const gl::DrawnStand& stand) {
  std::vector<const TreeMesh*> kinds;
  std::vector<std::uint32_t> number(stand.kinds.size(), ~0u);  // among those that stand
  Stand drawn{.trees = {}};
  for (const glm::vec3& shift : gl::copies(stand, glm::ivec2(gl::kDrawnAround)))
    for (const gl::DrawnTree& tree : stand.trees) {
      if (number[tree.kind] == ~0u) {
        number[tree.kind] = static_cast<std::uint32_t>(kinds.size());
        kinds.push_back(stand.kinds[tree.kind].tree.mesh.get());
      }
      drawn.trees.push_back({.position = tree.position + shift, .kind = number[tree.kind]});
    }
  if (!drawn.trees.empty()) scene_.emplace(kinds, drawn, true);
}

std::vector<glm::uvec2> VisibleByRays::operator()(const gl::View& view, const glm::ivec2& size) const {
  if (!scene_)
    return std::vector(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y),
                       glm::uvec2(kNothingSeen, 0u));
  return visibleSurfaces(*scene_, raysOf(view, size), glm::vec2(0.5f) + view.offset);
}

}  // namespace sunfleck::apps
