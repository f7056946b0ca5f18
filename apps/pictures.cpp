#include "apps/pictures.hpp"

#include "core/require.hpp"
#include "render/compare/exact_powers.hpp"
#include "render/gl/stand_picture.hpp"

namespace sunfleck::apps {

Image modelPicture(const Scene& scene, const StandGeometry& stand, Model model, const Progress& progress, int samples) {
  return gl::scenePicture(scene, stand, {.model = model, .samples = samples, .exact = exactPowerTable}, progress);
}

void showGround(Scene& scene) {
  scene.ground_albedo = glm::vec3(0.16f);
}

}  // namespace sunfleck::apps
