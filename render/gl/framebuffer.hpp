#pragma once

#include <glm/vec2.hpp>
#include <span>

#include "render/gl/object_name.hpp"

namespace sunfleck::gl {

// A picture of four 32-bit floats per pixel with a depth for each, in the current context's memory.
class Framebuffer {
 public:
  explicit Framebuffer(glm::ivec2 size);  // [pixel], > 0

  // Makes it what is drawn on, black and empty.
  void begin() const;
  // Copies the drawn pixels, rows from bottom to top; `values` holds 4 * width * height.
  void read(std::span<float> values) const;
  glm::ivec2 size() const { return size_; }

 private:
  static void destroyFramebuffer(unsigned name);
  static void destroyRenderbuffer(unsigned name);
  glm::ivec2 size_;
  ObjectName<&Framebuffer::destroyRenderbuffer> colour_, depth_;
  ObjectName<&Framebuffer::destroyFramebuffer> name_;
};

}  // namespace sunfleck::gl
