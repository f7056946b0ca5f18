#include "render/gl/radiance_texture.hpp"

#include <epoxy/gl.h>

#include <utility>

#include "render/gl/too_large.hpp"

namespace sunfleck::gl {
namespace {

unsigned created(glm::ivec2 size, GLint filter) {
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &name);
  glTextureStorage2D(name, 1, GL_RGB32F, size.x, size.y);
  for (const GLenum way : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) glTextureParameteri(name, way, filter);
  for (const GLenum way : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) glTextureParameteri(name, way, GL_CLAMP_TO_EDGE);
  return name;
}

}  // namespace

RadianceTexture::RadianceTexture(Read read, std::string what)
    : read_(read), what_(std::move(what)), name_(created(glm::ivec2(1), GL_NEAREST)) {}

void RadianceTexture::assign(glm::ivec2 size, std::span<const glm::vec3> values) {
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  if (size.x > most || size.y > most)
    throw TooLarge(what_ + " of " + std::to_string(size.x) + " x " + std::to_string(size.y) +
                   " cells: must be at most " + std::to_string(most) + " on a side for this OpenGL");
  const GLint filter = read_ == Read::cells ? GL_NEAREST : GL_LINEAR;
  name_ = ObjectName<&RadianceTexture::destroy>(created(size, filter));
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTextureSubImage2D(name_.get(), 0, 0, 0, size.x, size.y, GL_RGB, GL_FLOAT, values.data());
}

void RadianceTexture::bind(unsigned unit) const {
  glBindTextureUnit(unit, name_.get());
}

void RadianceTexture::destroy(unsigned name) {
  glDeleteTextures(1, &name);
}

}  // namespace sunfleck::gl
