#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "render/gl/drawn_stand.hpp"
#include "render/gl/volume_texture.hpp"

namespace sunfleck::gl {

// G and sky light of the cells of all trees of which they are told, each tree a block of its own in one texture.
class CellAtlas {
 public:
  // Sends what has changed; gives the bytes sent. Throws TooLarge with the figure.
  std::size_t update(const DrawnStand& stand);
  // The block of a tree, or kNone.
  std::uint32_t block(std::size_t tree) const { return trees_[tree].block; }
  glm::ivec3 blockSize() const { return block_size_; }  // [cell]
  glm::ivec3 blocks() const { return blocks_; }
  //   compensation, sky  texture units
  void bind(unsigned compensation, unsigned sky) const;

 private:
  struct Held {
    std::uint32_t block = ~0u;
    std::array<std::uint64_t, kMostLights> compensation{};  // revisions; 0: not told
    std::uint64_t sky_light = 0;
    bool operator==(const Held&) const = default;
  };
  std::size_t send(const DrawnStand& stand, std::size_t tree, const Held& now);

  std::vector<Held> trees_;
  glm::ivec3 block_size_{1}, blocks_{1};
  std::optional<VolumeTexture> compensation_, sky_;
};

}  // namespace sunfleck::gl
