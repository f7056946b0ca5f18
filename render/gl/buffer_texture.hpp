#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "render/gl/buffer.hpp"
#include "render/gl/object_name.hpp"
#include "render/gl/too_large.hpp"

namespace sunfleck::gl {

// A list of texels that shaders read by their number. It can be longer than a storage block may be, and software
// renderers read it faster.
class BufferTexture {
 public:
  enum class Texel { r32ui, rg32ui, rgb32ui, rgba32ui, r32f, rgba32f };
  //   what  it holds, for messages: "the light's opacity map takes"
  BufferTexture(Texel texel, std::string what, TooLarge::What what_is = TooLarge::What::other);

  // Makes room for so many texels; what it held is lost. Throws TooLarge with the figure.
  void resize(std::size_t texels);
  template <typename T>
  void write(std::size_t first_texel, std::span<const T> values) {
    writeBytes(first_texel, std::as_bytes(values));
  }
  void copy(std::size_t first_texel, const Buffer& from);
  // New content and no more.
  template <typename T>
  void assign(std::span<const T> values) {
    resize(values.size_bytes() / texel_bytes_);
    write(0, values);
  }
  std::size_t capacity() const { return capacity_; }  // [texel]
  void bind(unsigned unit) const;

 private:
  static void destroy(unsigned name);
  void writeBytes(std::size_t first_texel, std::span<const std::byte> bytes);

  unsigned format_;
  std::size_t texel_bytes_, capacity_ = 0;
  std::string what_;
  TooLarge::What what_is_;
  std::optional<Buffer> buffer_;
  ObjectName<&BufferTexture::destroy> name_;
};

}  // namespace sunfleck::gl
