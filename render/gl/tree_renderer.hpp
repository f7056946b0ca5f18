#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/image.hpp"
#include "core/progress.hpp"
#include "render/gl/context.hpp"
#include "render/gl/sun_map.hpp"
#include "render/model.hpp"
#include "render/scene.hpp"

namespace sunfleck::gl {

// G per cell for each tree of the stand; all trees have the prototype's cells (grid/cell_grid.hpp).
struct CompensationCells {
  glm::vec3 low{0.f};     // corner of cell (0, 0, 0) in the prototype's frame [m]
  float cell_size = 1.f;  // [m], > 0
  glm::ivec3 size{0};     // [cell]; 0: there are none, and G is 1
  std::vector<std::span<const float>> values;
};

// (R3) A scene and its sun on the GPU, ready to be seen by any camera and shaded by any model. It copies what it needs.
// A `context` must be current wherever it is used, and outlive it.
class TreeRenderer {
 public:
  // The trees' rotations must be 0. Throws std::runtime_error where the driver's limits are too small.
  TreeRenderer(const Context& context, const Scene& scene, const SunMap& sun, const CompensationCells& cells);
  ~TreeRenderer();
  TreeRenderer(TreeRenderer&&) noexcept;
  TreeRenderer& operator=(TreeRenderer&&) noexcept;

  // Channels R, G, B: linear radiance [W m^-2 sr^-1 per W m^-2 of sun], the mean over each pixel of 2 x 2 samples; A:
  // coverage [1]. The same picture is the same bits on the same driver.
  // Throws std::runtime_error("interrupted") when `progress` ends it.
  Image picture(const Camera& camera, Model model, const Progress& progress = {}) const;

 private:
  struct Resources;
  std::unique_ptr<Resources> resources_;
};

}  // namespace sunfleck::gl
