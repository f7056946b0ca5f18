#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/gl/buffer.hpp"
#include "render/gl/buffer_texture.hpp"
#include "render/gl/drawn_stand.hpp"

namespace sunfleck::gl {

// The deep opacity maps of all kinds along all lights, one after the other.
class MapPool {
 public:
  MapPool();
  // Sends the maps that are others; gives the bytes sent. Throws TooLarge with the figure.
  std::size_t update(const DrawnStand& stand);
  //   lines, crossings  texture units; frames  a uniform block
  void bind(unsigned lines, unsigned crossings, unsigned frames) const;

 private:
  struct Held {
    std::uint64_t revision = 0;
    std::size_t first_line = 0, lines = 0;          // room
    std::size_t first_crossing = 0, crossings = 0;  // room
  };
  bool fits(const DrawnStand& stand) const;
  void makeRoom(const DrawnStand& stand);
  std::size_t send(const LightMap& map, Held& held);

  BufferTexture lines_, crossings_;
  std::vector<Held> held_;  // 4 * kind + light
  Buffer frames_;
};

}  // namespace sunfleck::gl
