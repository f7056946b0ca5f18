#pragma once

#include <glm/vec3.hpp>
#include <span>

#include "render/gl/object_name.hpp"

namespace sunfleck::gl {

// A box of floats that shaders read with trilinear interpolation, clamped to its outermost texel centres.
class VolumeTexture {
 public:
  // `values`: x runs fastest, then y, then z. Throws std::runtime_error when a side is longer than OpenGL allows.
  VolumeTexture(glm::ivec3 size, std::span<const float> values);
  void bind(unsigned unit) const;
  static int longestSide();  // [texel]

 private:
  static void destroy(unsigned name);
  ObjectName<&VolumeTexture::destroy> name_;
};

}  // namespace sunfleck::gl
