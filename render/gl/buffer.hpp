#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "render/gl/object_name.hpp"

namespace sunfleck::gl {

// Memory of the current context, filled once from the program's, by and by, or by shaders.
class Buffer {
 public:
  // Values of a plain type, laid out as the shaders read them. An empty span becomes a few zero bytes, since OpenGL
  // knows no empty buffer.
  template <typename T>
  explicit Buffer(std::span<const T> values) : Buffer(std::as_bytes(values)) {}
  template <typename T>
  explicit Buffer(const std::vector<T>& values) : Buffer(std::span<const T>(values)) {}
  explicit Buffer(std::span<const std::byte> content);
  // Room that is filled by and by.
  static Buffer writable(std::size_t bytes);
  void write(std::size_t first_byte, std::span<const std::byte> content);
  // So many words of 4 bytes, all the same, for shaders to write.
  static Buffer filled(std::size_t words, std::uint32_t word);

  static std::size_t largestStorage();  // that shaders of the current context may read [byte]
  // Binds it for all shaders. Throws std::runtime_error when it is larger than the driver lets a shader read.
  void bindStorage(unsigned binding) const;
  void bindUniform(unsigned binding) const;
  unsigned name() const { return name_.get(); }

  std::size_t bytes() const { return bytes_; }

  // The content again.
  template <typename T>
  std::vector<T> read() const {
    std::vector<T> values(bytes_ / sizeof(T));
    read(std::span<T>(values));
    return values;
  }
  template <typename T>
  void read(std::span<T> values) const {
    readInto(std::as_writable_bytes(values));
  }

 private:
  explicit Buffer(std::size_t bytes);
  static void destroy(unsigned name);
  void readInto(std::span<std::byte> content) const;
  ObjectName<&Buffer::destroy> name_;
  std::size_t bytes_;
};

}  // namespace sunfleck::gl
