#include "apps/view/canvas.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace sunfleck::view {

void Canvas::destroyFramebuffer(unsigned name) {
  glDeleteFramebuffers(1, &name);
}

void Canvas::destroyTexture(unsigned name) {
  glDeleteTextures(1, &name);
}

void Canvas::resize(glm::ivec2 size) {
  if (size == size_) return;
  GLint longest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &longest);
  if (std::max(size.x, size.y) > longest)
    throw std::runtime_error(fmt::format("a window of {} x {} pixels: must be at most {} wide and high for this OpenGL",
                                         size.x, size.y, longest));
  unsigned name = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &name);
  texture_.emplace(name);
  glTextureStorage2D(name, 1, GL_RGBA8, size.x, size.y);
  unsigned framebuffer = 0;
  glCreateFramebuffers(1, &framebuffer);
  framebuffer_.emplace(framebuffer);
  glNamedFramebufferTexture(framebuffer, GL_COLOR_ATTACHMENT0, name, 0);
  size_ = size;
}

void Canvas::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_->get());
  glViewport(0, 0, size_.x, size_.y);
}

void Canvas::copyTo(const Canvas& other, glm::ivec2 corner) const {
  const glm::ivec2 low(corner.x, other.size_.y - corner.y - size_.y);
  glBlitNamedFramebuffer(framebuffer_->get(), other.framebuffer_->get(), 0, 0, size_.x, size_.y, low.x, low.y,
                         low.x + size_.x, low.y + size_.y, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

std::vector<std::uint8_t> Canvas::read() const {
  const auto row = 3 * static_cast<std::size_t>(size_.x);
  std::vector<std::uint8_t> pixels(row * static_cast<std::size_t>(size_.y));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureImage(texture_->get(), 0, GL_RGB, GL_UNSIGNED_BYTE, static_cast<GLsizei>(pixels.size()), pixels.data());
  for (int y = 0; y < size_.y / 2; ++y)
    std::swap_ranges(pixels.begin() + static_cast<std::ptrdiff_t>(row) * y,
                     pixels.begin() + static_cast<std::ptrdiff_t>(row) * (y + 1),
                     pixels.begin() + static_cast<std::ptrdiff_t>(row) * (size_.y - 1 - y));
  return pixels;
}

}  // namespace sunfleck::view
