#include "render/gl/sky_texture.hpp"

#include <epoxy/gl.h>

#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "render/gl/buffer_texture.hpp"

namespace sunfleck::gl {
namespace {

unsigned created(int columns, int rows) {
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &name);
  glTextureStorage2D(name, 1, GL_RGB32F, columns, rows);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glTextureParameteri(name, filter, GL_NEAREST);
  return name;
}

}  // namespace

SkyTexture::SkyTexture() : name_(created(1, 1)) {}

std::size_t SkyTexture::update(const std::shared_ptr<const SkyMap>& sky) {
  if (sky == sky_) return 0;
  sky_ = sky;
  if (!sky) return 0;
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  if (sky->columns() > most || sky->rows() > most)
    throw TooLarge("a sky of " + std::to_string(sky->columns()) + " x " + std::to_string(sky->rows()) +
                   " cells: must be at most " + std::to_string(most) + " on a side for this OpenGL");
  name_ = ObjectName<&SkyTexture::destroy>(created(sky->columns(), sky->rows()));
  const auto cells = static_cast<std::size_t>(sky->rows()) * static_cast<std::size_t>(sky->columns());
  std::vector<glm::vec3> radiance;
  radiance.reserve(cells);
  for (std::size_t cell = 0; cell < cells; ++cell) radiance.push_back(sky->radiance(cell));
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTextureSubImage2D(name_.get(), 0, 0, 0, sky->columns(), sky->rows(), GL_RGB, GL_FLOAT, radiance.data());
  return cells * sizeof radiance[0];
}

void SkyTexture::bind(unsigned unit) const {
  glBindTextureUnit(unit, name_.get());
}

void SkyTexture::destroy(unsigned name) {
  glDeleteTextures(1, &name);
}

}  // namespace sunfleck::gl
