#include "apps/pictures.hpp"

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

}  // namespace sunfleck::apps
