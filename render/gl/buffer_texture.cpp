#include "render/gl/buffer_texture.hpp"

#include <epoxy/gl.h>

#include <sstream>
#include <utility>

namespace sunfleck::gl {
namespace {

struct Format {
  GLenum name;
  std::size_t bytes;
};
Format formatOf(BufferTexture::Texel texel) {
  switch (texel) {
    case BufferTexture::Texel::r32ui:
      return {GL_R32UI, 4};
    case BufferTexture::Texel::rg32ui:
      return {GL_RG32UI, 8};
    case BufferTexture::Texel::rgb32ui:
      return {GL_RGB32UI, 12};
    case BufferTexture::Texel::rgba32ui:
      return {GL_RGBA32UI, 16};
    case BufferTexture::Texel::r32f:
      return {GL_R32F, 4};
    case BufferTexture::Texel::rgba32f:
      break;
  }
  return {GL_RGBA32F, 16};
}

unsigned created() {
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_BUFFER, 1, &name);
  return name;
}

std::size_t mostTexels() {
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  return static_cast<std::size_t>(std::max(most, 0));
}

}  // namespace

BufferTexture::BufferTexture(Texel texel, std::string what, TooLarge::What what_is)
    : format_(formatOf(texel).name),
      texel_bytes_(formatOf(texel).bytes),
      what_(std::move(what)),
      what_is_(what_is),
      name_(created()) {
  resize(0);
}

void BufferTexture::resize(std::size_t texels) {
  if (texels > mostTexels()) {
    std::ostringstream why;
    why.precision(4);
    why << what_ << " " << 1e-6 * static_cast<double>(texels * texel_bytes_) << " MB: must be at most "
        << 1e-6 * static_cast<double>(mostTexels() * texel_bytes_) << " MB for this OpenGL";
    throw TooLarge(what_is_, why.str());
  }
  buffer_.emplace(Buffer::writable(texels * texel_bytes_));
  capacity_ = texels;
  glTextureBuffer(name_.get(), format_, buffer_->name());
}

void BufferTexture::writeBytes(std::size_t first_texel, std::span<const std::byte> bytes) {
  buffer_->write(first_texel * texel_bytes_, bytes);
}

void BufferTexture::copy(std::size_t first_texel, const Buffer& from) {
  if (from.bytes() == 0) return;
  glCopyNamedBufferSubData(from.name(), buffer_->name(), 0, static_cast<GLintptr>(first_texel * texel_bytes_),
                           static_cast<GLsizeiptr>(from.bytes()));
}

void BufferTexture::bind(unsigned unit) const {
  glBindTextureUnit(unit, name_.get());
}

void BufferTexture::destroy(unsigned name) {
  glDeleteTextures(1, &name);
}

}  // namespace sunfleck::gl
