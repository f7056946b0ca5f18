#include "apps/pictures.hpp"

#include "core/require.hpp"
#include "render/gl/tree_picture.hpp"

namespace sunfleck::apps {

Image modelPicture(const Scene& scene, const StandGeometry& stand, Model model, const Progress& progress) {
  requireModelled(scene);
  gl::ShadingData data{.sun = &stand.light(0, 0), .cells = &stand.cells(0)};
  std::vector<std::vector<float>> none(scene.stand.trees.size());
  for (std::size_t tree = 0; tree < none.size(); ++tree) {
    data.compensation.push_back(stand.compensation(tree, 0));
    if (data.compensation.back().empty()) {  // not in the picture
      none[tree].resize(data.cells->count());
      data.compensation.back() = none[tree];
    }
  }
  return gl::treePicture(scene, data, model, progress);
}

void showGround(Scene& scene) {
  scene.ground_albedo = glm::vec3(0.16f);
}

PixelRays pixelRays(const Scene& scene) {
  const Camera camera = cameraOf(scene);
  require(!camera.perspective(), "camera field of view [rad]", camera.field_of_view, "0: Monte Carlo is orthographic");
  const Axes view = viewAxes(camera);
  const Bounds box = bounds(scene);
  // Far enough behind the target to see all in front, and the ground below, without losing digits.
  const float away = 4.f * (glm::length(box.size()) + glm::length(box.centre() - camera.target) + camera.half_width);
  const float pixel = 2.f * camera.half_width / static_cast<float>(camera.width);
  const float half_height = 0.5f * pixel * static_cast<float>(camera.height);
  return {.corner = camera.target - away * view.along - camera.half_width * view.right + half_height * view.up,
          .right_step = pixel * view.right,
          .down_step = -pixel * view.up,
          .sight = view.along,
          .width = camera.width,
          .height = camera.height};
}

}  // namespace sunfleck::apps
