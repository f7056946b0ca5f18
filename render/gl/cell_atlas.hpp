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
  bool has(std::size_t tree) const { return trees_[tree].block != kNoBlock; }
  // Of a tree's block, where it is told; of the texture [cell]
  glm::ivec3 corner(std::size_t tree) const { return has(tree) ? cornerOf(trees_[tree].block) : glm::ivec3(0); }
  glm::ivec3 size() const { return block_size_ * blocks_; }
  //   compensation, sky  texture units
  void bind(unsigned compensation, unsigned sky) const;

 private:
  static constexpr std::uint32_t kNoBlock = ~0u;
  struct Held {
    std::uint32_t block = kNoBlock;
    std::array<std::uint64_t, kMostLights> compensation{};  // revisions; 0: not told
    std::uint64_t sky_light = 0;
    bool operator==(const Held&) const = default;
  };
  glm::ivec3 cornerOf(std::uint32_t block) const;
  std::size_t send(const DrawnStand& stand, std::size_t tree, const Held& now);

  std::vector<Held> trees_;
  glm::ivec3 block_size_{1}, blocks_{1};
  std::optional<VolumeTexture> compensation_, sky_;
};

}  // namespace sunfleck::gl
