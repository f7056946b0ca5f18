#include "apps/pictures.hpp"

#include "render/gl/stand_picture.hpp"

namespace sunfleck::apps {

Image modelPicture(const Scene& scene, const StandGeometry& stand, Model model, const Progress& progress, int samples) {
  return gl::scenePicture(scene, stand, {.model = model, .samples = samples}, progress);
}

void showGround(Scene& scene) {
  scene.ground_albedo = glm::vec3(0.16f);
}

}  // namespace sunfleck::apps
