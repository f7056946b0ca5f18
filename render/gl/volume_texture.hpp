#pragma once

#include <glm/vec3.hpp>
#include <span>

#include "render/gl/object_name.hpp"

namespace sunfleck::gl {

// A box of texels of one or four floats that shaders read with trilinear interpolation, clamped to its outermost texel
// centres.
class VolumeTexture {
 public:
  // Throws TooLarge when a side is longer than OpenGL allows.
  VolumeTexture(glm::ivec3 size, int channels);
  // `values`: channels run fastest, then x, y and z.
  void write(glm::ivec3 corner, glm::ivec3 size, std::span<const float> values);
  int channels() const { return channels_; }
  void bind(unsigned unit) const;
  glm::ivec3 size() const { return size_; }
  static int longestSide();  // [texel]

 private:
  static void destroy(unsigned name);
  glm::ivec3 size_;
  int channels_;
  ObjectName<&VolumeTexture::destroy> name_;
};

}  // namespace sunfleck::gl
