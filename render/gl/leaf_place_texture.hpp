#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "render/gl/buffer_texture.hpp"
#include "render/shading/leaf_tables.hpp"

namespace sunfleck::gl {

// (R37) The pyramids of leaf maps of all kinds, as the shading text numbers their places.
class LeafPlaceTexture {
 public:
  LeafPlaceTexture();
  // Sends what has changed; gives the bytes sent. Throws TooLarge with the figure.
  std::size_t update(const shading::LeafTables& tables);
  void bind(unsigned unit) const { places_.bind(unit); }

 private:
  std::vector<std::shared_ptr<const shading::LeafPyramid>> sent_;  // one after the other
  BufferTexture places_;
};

}  // namespace sunfleck::gl
