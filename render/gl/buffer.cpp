#include "render/gl/buffer.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

namespace sunfleck::gl {
namespace {

constexpr std::array<std::byte, 16> kNothing{};

unsigned created() {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  return name;
}

}  // namespace

Buffer::Buffer(std::span<const std::byte> content) : name_(created()), bytes_(content.size()) {
  if (content.empty()) content = kNothing;
  glNamedBufferStorage(name_.get(), static_cast<GLsizeiptr>(content.size()), content.data(), 0);
}

Buffer::Buffer(std::size_t bytes) : name_(created()), bytes_(bytes) {
  glNamedBufferStorage(name_.get(), static_cast<GLsizeiptr>(std::max(bytes, kNothing.size())), nullptr,
                       GL_DYNAMIC_STORAGE_BIT);
}

Buffer Buffer::filled(std::size_t words, std::uint32_t word) {
  Buffer buffer(words * sizeof word);
  glClearNamedBufferData(buffer.name(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &word);
  return buffer;
}

Buffer Buffer::writable(std::size_t bytes) {
  return Buffer(bytes);
}

void Buffer::write(std::size_t first_byte, std::span<const std::byte> content) {
  if (content.empty()) return;
  glNamedBufferSubData(name_.get(), static_cast<GLintptr>(first_byte), static_cast<GLsizeiptr>(content.size()),
                       content.data());
}

std::size_t Buffer::largestStorage() {
  GLint64 most = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
  return static_cast<std::size_t>(std::max(most, GLint64{0}));
}

void Buffer::bindStorage(unsigned binding) const {
  if (bytes_ > largestStorage())
    throw std::runtime_error("a picture needs " + std::to_string(bytes_) + " bytes in one piece, and OpenGL allows " +
                             std::to_string(largestStorage()));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, name_.get());
}

void Buffer::bindUniform(unsigned binding) const {
  glBindBufferBase(GL_UNIFORM_BUFFER, binding, name_.get());
}

void Buffer::readInto(std::span<std::byte> content) const {
  glGetNamedBufferSubData(name_.get(), 0, static_cast<GLsizeiptr>(content.size()), content.data());
}

void Buffer::destroy(unsigned name) {
  glDeleteBuffers(1, &name);
}

}  // namespace sunfleck::gl
