#pragma once

#include <optional>

#include "render/model.hpp"
#include "render/scene.hpp"
#include "render/stand_geometry.hpp"

namespace sunfleck::view {

// What the viewer edits, and undoes as one. Of kinds whose leaves have textures it holds what was told of them: after
// an edit there are no maps, and `leaf` is not their mean but `even`. The worker makes both (MadeLeaves), so that
// hundreds of documents are kept in little room.
struct Document {
  Scene scene;
  Model model = Model::sppg;
  GeometryEffort effort{.light_resolution = 1024};
  std::optional<std::size_t> selected;  // one of the stand's trees
};

}  // namespace sunfleck::view
