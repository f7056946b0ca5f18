#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "render/gl/object_name.hpp"

namespace sunfleck::view {

// A picture of 8-bit colours in the current OpenGL context, to be drawn on and read.
class Canvas {
 public:
  // Makes it of this size, if it is not. Throws std::runtime_error with the figure beyond what OpenGL allows.
  void resize(glm::ivec2 size);
  glm::ivec2 size() const { return size_; }
  void bind() const;  // what is drawn now goes here; the viewport is all of it
  unsigned framebuffer() const { return framebuffer_->get(); }
  // Its pixels to a part of another, whose upper left corner is given.
  void copyTo(const Canvas& other, glm::ivec2 corner) const;
  std::vector<std::uint8_t> read() const;  // red, green, blue; rows from the top

 private:
  static void destroyFramebuffer(unsigned name);
  static void destroyTexture(unsigned name);
  glm::ivec2 size_{0};
  std::optional<gl::ObjectName<&Canvas::destroyTexture>> texture_;
  std::optional<gl::ObjectName<&Canvas::destroyFramebuffer>> framebuffer_;
};

}  // namespace sunfleck::view
