#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "render/gl/buffer_texture.hpp"
#include "render/gl/drawn_stand.hpp"
#include "render/gl/tree_levels.hpp"

namespace sunfleck::gl {

// (R37) Where the triangles of kinds with leaf maps lie in the images of their leaves, those of all levels of detail:
// two texels for each, shading::ImageMap.
class ImageMapTexture {
 public:
  ImageMapTexture();
  // Sends what has changed; gives the bytes sent. Throws TooLarge with the figure.
  //   levels  of each kind's mesh
  std::size_t update(const DrawnStand& stand, const std::vector<std::shared_ptr<const TreeLevels>>& levels);
  // One more than the number of the kind's first triangle here; 0: there is none.
  std::uint32_t first(std::size_t kind) const { return kinds_[kind].first; }
  void bind(unsigned unit) const { maps_.bind(unit); }

 private:
  struct Held {
    std::shared_ptr<const TreeLevels> levels;  // none: of a kind without maps, or that does not tell where they lie
    std::uint32_t first = 0;
    bool operator==(const Held&) const = default;
  };
  std::vector<Held> kinds_;
  BufferTexture maps_;
};

}  // namespace sunfleck::gl
