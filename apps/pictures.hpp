#pragma once

#include <glm/geometric.hpp>

#include "apps/display_options.hpp"
#include "core/image.hpp"
#include "render/leaf_models.hpp"
#include "render/scene.hpp"
#include "render/stand_geometry.hpp"

namespace sunfleck::apps {

// Lets a picture stand on a ground that shows its shadows: one that reflects a sixth of the light.
void showGround(Scene& scene);

// The scene shaded by a model on the GPU; `stand` is up to date for it and the model.
//   samples  of each pixel
Image modelPicture(const Scene& scene, const StandGeometry& stand, Model model, const Progress& progress = {},
                   int samples = 4);

}  // namespace sunfleck::apps
