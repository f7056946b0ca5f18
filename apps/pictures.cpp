#include "apps/pictures.hpp"

#include "render/gl/tree_picture.hpp"

namespace sunfleck::apps {

Image modelPicture(const Scene& scene, const StandGeometry& stand, Model model, const Progress& progress) {
  gl::ShadingData data{.sun = &stand.light(), .cells = &stand.cells()};
  for (const std::vector<float>& of_tree : stand.compensation()) data.compensation.emplace_back(of_tree);
  return gl::treePicture(scene, data, model, progress);
}

void showGround(Scene& scene) {
  scene.ground_albedo = glm::vec3(0.16f);
}

}  // namespace sunfleck::apps
