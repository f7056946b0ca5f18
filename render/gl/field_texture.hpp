#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/gl/buffer_texture.hpp"
#include "render/gl/drawn_stand.hpp"
#include "render/gl/tree_levels.hpp"

namespace sunfleck::gl {

// (F26) What the light field tells of the places of all trees of which it is told: two texels of a place, its front and
// its back. Then what it tells of the ground's cells (F31).
class FieldTexture {
 public:
  FieldTexture();
  // Sends what has changed; gives the bytes sent. Throws TooLarge with the figure.
  //   levels  of each kind, as their triangles are numbered one kind after the other
  std::size_t update(const DrawnStand& stand, const std::vector<const TreeLevels*>& levels);
  // One more than the first place of a tree; 0: none is told.
  std::uint32_t place(std::size_t tree) const { return trees_[tree].first == ~0u ? 0u : trees_[tree].first / 2 + 1; }
  // One more than the texel of the ground's first cell; 0: nothing is told of the ground.
  std::uint32_t ground() const { return ground_.first == ~0u ? 0u : ground_.first + 1; }
  //   places, light  texture units
  void bind(unsigned places, unsigned light) const;

 private:
  struct Held {
    std::uint32_t first = ~0u;
    std::uint64_t revision = 0;
    bool operator==(const Held&) const = default;
  };
  std::size_t sendPlaces(const DrawnStand& stand, const std::vector<const TreeLevels*>& levels);

  std::vector<Held> trees_;
  Held ground_;
  std::vector<std::uint32_t> held_places_;
  BufferTexture places_, light_;
};

}  // namespace sunfleck::gl
