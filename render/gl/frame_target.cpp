#include "render/gl/frame_target.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <stdexcept>
#include <string>

#include "render/gl/detail/frame_data.hpp"
#include "render/gl/too_large.hpp"

namespace sunfleck::gl {
namespace {

constexpr int kRadiances = 5;  // layers that are sums

unsigned createdFramebuffer() {
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  return name;
}

unsigned createdDepth(glm::ivec2 size) {
  GLuint name = 0;
  glCreateRenderbuffers(1, &name);
  glNamedRenderbufferStorage(name, GL_DEPTH_COMPONENT32F, size.x, size.y);
  return name;
}

glm::ivec2 checked(glm::ivec2 size) {
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  if (size.x > most || size.y > most)
    throw TooLarge("a picture of " + std::to_string(size.x) + " x " + std::to_string(size.y) +
                   " pixels: must be at most " + std::to_string(most) + " on a side for this OpenGL");
  return glm::max(size, glm::ivec2(1));
}

void requireComplete(unsigned framebuffer) {
  if (glCheckNamedFramebufferStatus(framebuffer, GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("OpenGL cannot draw on pictures of 32-bit floats");
}

}  // namespace

FrameTarget::Texture FrameTarget::texture(unsigned format, glm::ivec2 size) {
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &name);
  glTextureStorage2D(name, 1, format, size.x, size.y);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glTextureParameteri(name, filter, GL_NEAREST);
  return Texture(name);
}

FrameTarget::FrameTarget(glm::ivec2 size, bool layers)
    : size_(checked(size)),
      visible_(texture(GL_RG32UI, size_)),
      depth_(createdDepth(size_)),
      visible_target_(createdFramebuffer()),
      shading_target_(createdFramebuffer()) {
  glNamedFramebufferTexture(visible_target_.get(), GL_COLOR_ATTACHMENT0, visible_.get(), 0);
  glNamedFramebufferRenderbuffer(visible_target_.get(), GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_.get());
  requireComplete(visible_target_.get());
  std::array<GLenum, kLayers> attachments{};
  const int count = layers ? kLayers : 1;
  for (int layer = 0; layer < count; ++layer) {
    textures_.push_back(texture(layer == static_cast<int>(Layer::ids) ? GL_RGBA32UI : GL_RGBA32F, size_));
    attachments[static_cast<std::size_t>(layer)] = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(layer);
    glNamedFramebufferTexture(shading_target_.get(), attachments[static_cast<std::size_t>(layer)],
                              textures_.back().get(), 0);
  }
  glNamedFramebufferDrawBuffers(shading_target_.get(), count, attachments.data());
  requireComplete(shading_target_.get());
}

void FrameTarget::beginVisible() const {
  glBindFramebuffer(GL_FRAMEBUFFER, visible_target_.get());
  glViewport(0, 0, size_.x, size_.y);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_TRUE);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
  constexpr std::array<GLuint, 4> none{detail::kNone, detail::kNone, 0, 0};
  constexpr GLfloat farthest = 0.f;
  glClearNamedFramebufferuiv(visible_target_.get(), GL_COLOR, 0, none.data());
  glClearNamedFramebufferfv(visible_target_.get(), GL_DEPTH, 0, &farthest);
}

void FrameTarget::setVisible(std::span<const glm::uvec2> ids) {
  assert(ids.size() == static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y));
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTextureSubImage2D(visible_.get(), 0, 0, 0, size_.x, size_.y, GL_RG_INTEGER, GL_UNSIGNED_INT, ids.data());
}

glm::uvec2 FrameTarget::visibleAt(glm::ivec2 pixel) const {
  glm::uvec2 id(0u);
  glGetTextureSubImage(visible_.get(), 0, pixel.x, pixel.y, 0, 1, 1, 1, GL_RG_INTEGER, GL_UNSIGNED_INT, sizeof id, &id);
  return id;
}

void FrameTarget::clearLayers() const {
  constexpr std::array<GLfloat, 4> none{}, far{0.f, 0.f, 0.f, std::numeric_limits<float>::infinity()};
  constexpr std::array<GLuint, 4> no_ids{detail::kNone, detail::kNone, detail::kNone, detail::kNone};
  for (GLint layer = 0; layer < static_cast<GLint>(textures_.size()); ++layer)
    if (layer == static_cast<GLint>(Layer::ids))
      glClearNamedFramebufferuiv(shading_target_.get(), GL_COLOR, layer, no_ids.data());
    else
      glClearNamedFramebufferfv(shading_target_.get(), GL_COLOR, layer,
                                layer == static_cast<GLint>(Layer::geometry) ? far.data() : none.data());
}

void FrameTarget::beginShading(bool accumulate, const PixelBox& shown) {
  samples_ = accumulate ? samples_ + 1 : 1;
  glBindFramebuffer(GL_FRAMEBUFFER, shading_target_.get());
  glViewport(0, 0, size_.x, size_.y);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
  const bool whole = shown == PixelBox{.low = glm::ivec2(0), .high = size_};
  if (!whole && !accumulate) clearLayers();
  if (!whole) {
    glEnable(GL_SCISSOR_TEST);
    glScissor(shown.low.x, shown.low.y, shown.high.x - shown.low.x, shown.high.y - shown.low.y);
  }
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE, GL_ONE);
  for (GLuint layer = 0; layer < textures_.size(); ++layer)
    if (samples_ > 1 && layer < kRadiances)
      glEnablei(GL_BLEND, layer);
    else
      glDisablei(GL_BLEND, layer);
}

std::vector<float> FrameTarget::read(Layer layer) const {
  std::vector<float> values(4 * static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y));
  glGetTextureImage(texture(layer), 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(values.size() * sizeof values[0]),
                    values.data());
  if (static_cast<int>(layer) < kRadiances && samples_ > 1)
    for (float& value : values) value /= static_cast<float>(samples_);
  return values;
}

std::vector<std::uint32_t> FrameTarget::readIds() const {
  std::vector<std::uint32_t> ids(4 * static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y));
  glGetTextureImage(texture(Layer::ids), 0, GL_RGBA_INTEGER, GL_UNSIGNED_INT,
                    static_cast<GLsizei>(ids.size() * sizeof ids[0]), ids.data());
  return ids;
}

void FrameTarget::destroyFramebuffer(unsigned name) {
  glDeleteFramebuffers(1, &name);
}
void FrameTarget::destroyRenderbuffer(unsigned name) {
  glDeleteRenderbuffers(1, &name);
}
void FrameTarget::destroyTexture(unsigned name) {
  glDeleteTextures(1, &name);
}

}  // namespace sunfleck::gl
