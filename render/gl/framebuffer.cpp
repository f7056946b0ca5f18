#include "render/gl/framebuffer.hpp"

#include <epoxy/gl.h>

#include <array>
#include <stdexcept>

namespace sunfleck::gl {
namespace {

unsigned createdRenderbuffer(GLenum format, glm::ivec2 size) {
  GLuint name = 0;
  glCreateRenderbuffers(1, &name);
  glNamedRenderbufferStorage(name, format, size.x, size.y);
  return name;
}

unsigned createdFramebuffer() {
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  return name;
}

}  // namespace

Framebuffer::Framebuffer(glm::ivec2 size)
    : size_(size),
      colour_(createdRenderbuffer(GL_RGBA32F, size)),
      depth_(createdRenderbuffer(GL_DEPTH_COMPONENT32F, size)),
      name_(createdFramebuffer()) {
  glNamedFramebufferRenderbuffer(name_.get(), GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_.get());
  glNamedFramebufferRenderbuffer(name_.get(), GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_.get());
  if (glCheckNamedFramebufferStatus(name_.get(), GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("OpenGL cannot draw on pictures of 32-bit floats");
}

void Framebuffer::begin() const {
  glBindFramebuffer(GL_FRAMEBUFFER, name_.get());
  glViewport(0, 0, size_.x, size_.y);
  constexpr std::array<GLfloat, 4> black{};
  constexpr GLfloat farthest = 1.f;
  glClearNamedFramebufferfv(name_.get(), GL_COLOR, 0, black.data());
  glClearNamedFramebufferfv(name_.get(), GL_DEPTH, 0, &farthest);
}

void Framebuffer::read(std::span<float> values) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, name_.get());
  glReadPixels(0, 0, size_.x, size_.y, GL_RGBA, GL_FLOAT, values.data());
}

void Framebuffer::destroyFramebuffer(unsigned name) {
  glDeleteFramebuffers(1, &name);
}

void Framebuffer::destroyRenderbuffer(unsigned name) {
  glDeleteRenderbuffers(1, &name);
}

}  // namespace sunfleck::gl
