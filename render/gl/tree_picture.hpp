#pragma once

#include <string>
#include <vector>

#include "core/image.hpp"
#include "grid/deep_opacity_map.hpp"
#include "grid/instance_cells.hpp"
#include "render/scene.hpp"

namespace sunfleck::gl {

enum class ShadingModel { ss, spp, sppg };

// What the fragments of one tree read besides its mesh.
struct ShadingData {
  const DeepOpacityMap* sun = nullptr;  // along the scene's sun
  const CellGrid* cells = nullptr;
  std::vector<std::span<const float>> compensation;  // G per cell, for each tree of the stand
};

// (R3) The scene as the GPU shades it: leaves by the model, wood and ground in direct light, seen by the scene's camera
// before a black sky. Channels R, G, B: linear radiance; A: coverage. Needs no display. Throws std::runtime_error when
// there is no OpenGL 4.5.
Image treePicture(const Scene& scene, const ShadingData& data, ShadingModel model);

}  // namespace sunfleck::gl
