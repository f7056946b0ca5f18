#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image.hpp"

namespace sunfleck::detail {

// What an image file says of itself.
struct StoredImage {
  int width = 0, height = 0, depth = 0;  // [pixel]
  std::vector<std::string> channels;     // as the file calls them
  int alpha_channel = -1;                // -1: none is told
  bool floating = false;                 // floating-point numbers, else whole ones
};

// What OpenImageIO does for us. It brings some 240 libraries with it, which take a quarter of a second to load: so it
// is in a library of its own, loaded when an image is first read or written. All functions throw std::runtime_error
// with a reason of one line.
class ImageCodec {
 public:
  virtual ~ImageCodec() = default;

  // The first subimage, rows from the top, colours not multiplied by alpha; its channels as the file calls them.
  //   bytes  of the image, where they are not those of the file, which then tells its format alone: PNG or JPEG
  //   check  may throw before any pixel is read
  virtual Image read(const std::filesystem::path& file, std::string_view bytes,
                     const std::function<void(const StoredImage&)>& check) const = 0;
  virtual void writeExr(const std::filesystem::path& file, const Image& image) const = 0;
  // A PNG of 8-bit sRGB codes, row after row.
  virtual std::string png(int width, int height, int channels, std::span<const std::uint8_t> codes) const = 0;
  // A PNG of 16-bit values, proportional to what they tell, colours not multiplied by alpha.
  virtual std::string linearPng(int width, int height, int channels, std::span<const std::uint16_t> codes) const = 0;
};

const ImageCodec& imageCodec();

}  // namespace sunfleck::detail
