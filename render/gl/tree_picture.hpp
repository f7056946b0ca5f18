#pragma once

#include <span>
#include <vector>

#include "core/image.hpp"
#include "core/progress.hpp"
#include "grid/cell_grid.hpp"
#include "grid/deep_opacity_map.hpp"
#include "render/gl/opacity_maps.hpp"
#include "render/model.hpp"
#include "render/scene.hpp"

namespace sunfleck::gl {

// What the fragments of one tree read besides its mesh.
struct ShadingData {
  const DeepOpacityMap* sun = nullptr;               // along the scene's sun
  const CellGrid* cells = nullptr;                   // of the prototype; for sppg alone
  std::vector<std::span<const float>> compensation;  // G per cell, for each tree of the stand; for sppg alone
};

// (R3) The scene as the GPU shades it: leaves, wood and a disc of ground by the model, seen by the scene's camera
// before a black sky. A periodic stand is drawn with one ring of copies; ground of albedo 0 in all bands is left out.
// Channels R, G, B: linear radiance; A: coverage. Needs no display. Throws InvalidInput on a camera that sees nothing
// or a rotated tree, MapTooLarge, and std::runtime_error when there is no OpenGL 4.5 or `progress` ends it.
Image treePicture(const Scene& scene, const ShadingData& data, Model model, const Progress& progress = {});

}  // namespace sunfleck::gl
