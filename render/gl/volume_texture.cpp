#include "render/gl/volume_texture.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <initializer_list>
#include <string>

#include "render/gl/too_large.hpp"

namespace sunfleck::gl {
namespace {

unsigned created() {
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_3D, 1, &name);
  return name;
}

}  // namespace

VolumeTexture::VolumeTexture(glm::ivec3 size, int channels) : size_(size), channels_(channels), name_(created()) {
  const int longest = std::max({size.x, size.y, size.z});
  if (longest > longestSide())
    throw TooLarge("the trees' cells need a texture of " + std::to_string(longest) + " texels, and OpenGL allows " +
                   std::to_string(longestSide()));
  const GLuint name = name_.get();
  glTextureStorage3D(name, 1, channels == 1 ? GL_R32F : GL_RGBA32F, size.x, size.y, size.z);
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  for (const GLenum wrap : std::initializer_list<GLenum>{GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    glTextureParameteri(name, wrap, GL_CLAMP_TO_EDGE);
}

void VolumeTexture::write(glm::ivec3 corner, glm::ivec3 size, std::span<const float> values) {
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTextureSubImage3D(name_.get(), 0, corner.x, corner.y, corner.z, size.x, size.y, size.z,
                      channels_ == 1 ? GL_RED : GL_RGBA, GL_FLOAT, values.data());
}

void VolumeTexture::bind(unsigned unit) const {
  glBindTextureUnit(unit, name_.get());
}

int VolumeTexture::longestSide() {
  GLint longest = 0;
  glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &longest);
  return longest;
}

void VolumeTexture::destroy(unsigned name) {
  glDeleteTextures(1, &name);
}

}  // namespace sunfleck::gl
