#include "render/scene_images.hpp"

#include "core/distinct_files.hpp"

namespace sunfleck {

void requireNoImageOf(const Scene& scene, const std::filesystem::path& output) {
  requireOther(output, scene.ground_texture_file);
  requireOther(output, scene.sky.file);
  for (const TreeKind& kind : scene.kinds)
    for (const LeafSideTextures* side : {&kind.textures.upper, &kind.textures.lower})
      for (const auto& image : {side->detail, side->gloss})
        if (image) requireOther(output, image->file);
}

}  // namespace sunfleck
