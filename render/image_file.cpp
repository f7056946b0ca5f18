#include "render/image_file.hpp"

#include <algorithm>
#include <cassert>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "core/require.hpp"
#include "core/whole_file.hpp"
#include "render/detail/image_codec.hpp"

namespace sunfleck {
namespace fs = std::filesystem;
namespace {

std::string lowered(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// The channels that a screen shows: R, G, B where there are all three, else the first as grey.
std::vector<std::size_t> shownChannels(const Image& image) {
  std::vector<std::size_t> shown;
  for (std::string_view name : {"R", "G", "B"}) {
    const auto found = std::ranges::find(image.channels, name);
    if (found != image.channels.end()) shown.push_back(static_cast<std::size_t>(found - image.channels.begin()));
  }
  return shown.size() == 3 ? shown : std::vector<std::size_t>{0};
}

constexpr int kMostWidth = 8192, kMostHeight = 4096;  // of a picture that is read

Image read(const fs::path& file, std::string_view bytes, const std::function<void(const detail::StoredImage&)>& check) {
  try {
    return detail::imageCodec().read(file, bytes, check);
  } catch (const std::runtime_error& e) {
    throw InvalidInput(file.string() + ": cannot be read: " + e.what());
  }
}

// `also` may refuse what is told of the image, before any pixel is read.
Image decoded(const fs::path& file, std::string_view bytes, ImageValues values,
              const std::function<void(const detail::StoredImage&)>& also) {
  const auto refuse = [&](const std::string& why) { throw InvalidInput(file.string() + ": cannot be read: " + why); };
  std::error_code failure;
  if (bytes.empty() && fs::exists(file, failure) && !fs::is_regular_file(file, failure))
    refuse("it is no regular file");
  if (bytes.empty() && !fs::exists(file, failure)) refuse("there is no such file");
  if (!bytes.empty() && !file.has_extension()) refuse("its format is not told");
  detail::StoredImage stored;
  Image image = read(file, bytes, [&](const detail::StoredImage& of_file) {
    stored = of_file;
    if (stored.width < 1 || stored.height < 1 || stored.width > kLargestImage || stored.height > kLargestImage ||
        stored.depth > 1)
      refuse("it must be a flat image of at most 8192 x 8192 pixels");
    if (stored.channels.empty() || stored.channels.size() > 4) refuse("it must have one to four channels");
    if (also) also(stored);
  });
  const std::size_t channels = stored.channels.size();
  const bool has_alpha = stored.alpha_channel >= 0 || channels == 2 || channels == 4;
  const std::size_t alpha = !has_alpha                  ? channels
                            : stored.alpha_channel >= 0 ? static_cast<std::size_t>(stored.alpha_channel)
                                                        : channels - 1;
  const std::size_t colours = channels - (has_alpha ? 1 : 0);
  for (std::size_t c = 0, colour = 0; c < channels; ++c)
    image.channels[c] = c == alpha ? "A" : colours == 3 ? std::string(1, "RGB"[colour++]) : "Y";
  const bool decode = values == ImageValues::linear && !stored.floating;
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    float& value = image.values[i];
    if (!std::isfinite(value)) refuse("it holds a value that is not a finite number");
    if (decode && i % channels != alpha) value = tone_mapping::srgbLight(value);
  }
  return image;
}

void writeExr(const fs::path& file, const Image& image) {
  writeWhole(file, [&](const fs::path& temporary) {
    try {
      detail::imageCodec().writeExr(temporary, image);
    } catch (const std::runtime_error& e) {
      throw InvalidInput(file.string() + ": cannot be written: " + e.what());
    }
  });
}

}  // namespace

Image readRadiances(const fs::path& file) {
  const std::string extension = lowered(file.extension().string());
  if (extension != ".exr" && extension != ".hdr")
    throw InvalidInput(file.string() + ": has the extension \"" + file.extension().string() +
                       "\": a picture of radiances must be .exr or .hdr");
  if (!fs::is_regular_file(file)) throw InvalidInput(file.string() + ": must be a file that can be read");
  return read(file, {}, [&](const detail::StoredImage& stored) {
    if (stored.width < 1 || stored.width > kMostWidth || stored.height < 1 || stored.height > kMostHeight ||
        stored.depth != 1 || stored.channels.empty() || stored.channels.size() > 64)
      throw InvalidInput(file.string() + ": has " + std::to_string(stored.width) + " x " +
                         std::to_string(stored.height) + " pixels of " + std::to_string(stored.channels.size()) +
                         " channels: must be at most " + std::to_string(kMostWidth) + " x " +
                         std::to_string(kMostHeight) + " of 64");
  });
}

void requirePictureName(const fs::path& file) {
  const std::string extension = lowered(file.extension().string());
  if (extension != ".png" && extension != ".exr")
    throw InvalidInput(file.string() + ": has the extension \"" + file.extension().string() +
                       "\": a picture's must be .exr or .png");
  requireWritable(file);
}

void writeImage(const fs::path& file, const Image& image, const Display& display) {
  assert(image.values.size() == image.at(0, image.height, 0));
  requirePictureName(file);
  if (lowered(file.extension().string()) == ".png")
    writeWhole(file, pngBytes(image, display));
  else
    writeExr(file, image);
}

void writeValues(const fs::path& file, const Image& image) {
  assert(image.values.size() == image.at(0, image.height, 0));
  requirePictureName(file);
  if (lowered(file.extension().string()) == ".png") {
    constexpr float kLargest = 65535.f;
    std::vector<std::uint16_t> codes;
    codes.reserve(image.values.size());
    for (const float value : image.values)
      codes.push_back(static_cast<std::uint16_t>(std::lround(kLargest * std::clamp(value, 0.f, 1.f))));
    writeWhole(file, detail::imageCodec().linearPng(image.width, image.height, static_cast<int>(image.channels.size()),
                                                    codes));
  } else {
    writeExr(file, image);
  }
}

void writePng(const fs::path& file, int width, int height, std::span<const std::uint8_t> colours) {
  if (lowered(file.extension().string()) != ".png")
    throw InvalidInput(file.string() + ": has the extension \"" + file.extension().string() + "\": must be .png");
  requireWritable(file);
  writeWhole(file, detail::imageCodec().png(width, height, 3, colours));
}

Image readImage(const fs::path& file, ImageValues values) {
  return decoded(file, {}, values, {});
}

Image readOpacity(const fs::path& file, std::string_view bytes) {
  std::error_code failure;
  const std::uintmax_t size = bytes.empty() ? fs::file_size(file, failure) : bytes.size();
  // Pictures of leaves shrink to a tenth, outlines of one colour to a hundredth; files made to burst to a thousandth.
  constexpr std::uintmax_t kMostGrowth = 400, kSmall = 1u << 22;
  return decoded(file, bytes, ImageValues::as_they_stand, [&](const detail::StoredImage& stored) {
    const auto values =
        static_cast<std::uintmax_t>(stored.width) * static_cast<std::uintmax_t>(stored.height) * stored.channels.size();
    if (stored.width > kLargestOpacity || stored.height > kLargestOpacity ||
        (!failure && values > kSmall && values > kMostGrowth * size))
      throw InvalidInput(file.string() + ": cannot be read: says to be of " + std::to_string(stored.width) + " x " +
                         std::to_string(stored.height) + " pixels in " + std::to_string(size) +
                         " bytes: must be at most 4096 x 4096, and 400 values a byte");
  });
}

std::string pngBytes(const Image& image, const Display& display) {
  const std::vector<std::size_t> shown = shownChannels(image);
  std::vector<std::uint8_t> codes;
  codes.reserve(image.values.size());
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (const std::size_t channel : shown)
        codes.push_back(
            static_cast<std::uint8_t>(std::lround(255.f * display.code(image.values[image.at(x, y, channel)]))));

  try {
    return detail::imageCodec().png(image.width, image.height, static_cast<int>(shown.size()), codes);
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(std::string("no PNG can be made: ") + e.what());
  }
}

}  // namespace sunfleck
