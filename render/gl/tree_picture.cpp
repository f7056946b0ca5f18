#include "render/gl/tree_picture.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <sstream>
#include <stdexcept>
#include <string>

#include "core/require.hpp"
#include "render/gl/buffer.hpp"
#include "render/gl/context.hpp"
#include "render/gl/tree_renderer.hpp"

namespace sunfleck::gl {
namespace {

constexpr int kLongestSide = 16384;      // [pixel]
constexpr float kSameDirection = 1e-4f;  // [1], length of the difference of two directions that are the same

void requireDrawable(const Scene& scene, const Camera& camera) {
  for (const int side : {camera.width, camera.height})
    require(side > 0 && side <= kLongestSide, "picture size [pixel]", side, "1 .. " + std::to_string(kLongestSide));
  require(std::isfinite(camera.half_width) && camera.half_width > 0.f, "camera half width [m]", camera.half_width,
          "a finite number above 0");
  require(!camera.perspective(), "camera field of view [rad]", camera.field_of_view,
          "0: models' pictures are orthographic");
  for (const Placement& tree : scene.stand.trees)
    require(tree.rotation == 0.f, "tree rotation [rad]", tree.rotation,
            "0: pictures share one opacity map among all trees, which a rotated tree does not fit");
}

// These are the program's own mistakes, not the user's.
void requireFitting(const Scene& scene, const ShadingData& data, Model model) {
  if (!data.sun || glm::length(data.sun->along() - scene.sun().light()) > kSameDirection)
    throw std::invalid_argument("treePicture: the opacity map is not along the scene's sun");
  if (!needsCompensation(model)) return;
  bool fits = data.cells && data.compensation.size() == scene.stand.trees.size();
  for (const std::span<const float>& values : data.compensation) fits = fits && values.size() == data.cells->count();
  if (!fits) throw std::invalid_argument("treePicture: G is not given for every cell of every tree");
}

void requireRoom(const SunMap& map) {
  const std::size_t bytes = std::max(map.crossings.size_bytes(), map.first.size_bytes());
  if (bytes <= Buffer::largestStorage()) return;
  std::ostringstream why;
  why.precision(4);
  why << "the light's opacity map takes " << 1e-6 * static_cast<double>(bytes) << " MB in one piece: must be at most "
      << 1e-6 * static_cast<double>(Buffer::largestStorage()) << " MB for this OpenGL";
  throw MapTooLarge(why.str());
}

}  // namespace

Image treePicture(const Scene& scene, const ShadingData& data, Model model, const Progress& progress) {
  const Camera camera = cameraOf(scene);
  requireDrawable(scene, camera);
  requireFitting(scene, data, model);
  const SunMap sun{.axes = data.sun->axes(),
                   .origin = data.sun->inMap(glm::vec3(0.f)),
                   .corner = data.sun->corner(),
                   .pixel_size = data.sun->pixelSize(),
                   .size = data.sun->size(),
                   .first = data.sun->first(),
                   .crossings = data.sun->crossings(),
                   .wood_depth = data.sun->woodDepth()};
  CompensationCells cells;
  if (needsCompensation(model))
    cells = {.low = data.cells->low,
             .cell_size = data.cells->cell_size,
             .size = data.cells->size,
             .values = data.compensation};
  const Context context;
  requireRoom(sun);
  return TreeRenderer(context, scene, sun, cells).picture(camera, model, progress);
}

}  // namespace sunfleck::gl
