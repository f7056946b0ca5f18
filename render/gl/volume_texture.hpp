#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>

#include "render/gl/object_name.hpp"

namespace sunfleck::gl {

// A box of texels of four floats that shaders read with trilinear interpolation, clamped to its outermost texel centres.
class VolumeTexture {
 public:
  // Throws std::runtime_error when a side is longer than OpenGL allows.
  explicit VolumeTexture(glm::ivec3 size);
  // `values`: x runs fastest, then y, then z.
  void write(glm::ivec3 corner, glm::ivec3 size, std::span<const glm::vec4> values);
  void bind(unsigned unit) const;
  glm::ivec3 size() const { return size_; }
  static int longestSide();  // [texel]

 private:
  static void destroy(unsigned name);
  glm::ivec3 size_;
  ObjectName<&VolumeTexture::destroy> name_;
};

}  // namespace sunfleck::gl
