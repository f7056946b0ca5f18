#include "render/image_file.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cassert>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/require.hpp"
#include "core/whole_file.hpp"

namespace sunfleck {
namespace fs = std::filesystem;
namespace {

// The line that OpenImageIO has left, cut to one.
std::string reason(const OIIO::ImageOutput* out) {
  std::string text = out ? out->geterror() : OIIO::geterror();
  text.resize(std::min(text.find('\n'), text.size()));
  return text.empty() ? "OpenImageIO gives no reason" : text;
}

std::string lowered(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// IEC 61966-2-1: linear light [1] to the code value of an 8-bit sRGB picture. What is not a number shows as black.
std::uint8_t sRgbCode(float linear) {
  const float light = linear > 0.f ? std::min(linear, 1.f) : 0.f;
  const float encoded = light <= 0.0031308f ? 12.92f * light : 1.055f * std::pow(light, 1.f / 2.4f) - 0.055f;
  return static_cast<std::uint8_t>(std::lround(255.f * encoded));
}

// The other way, from a code value over the largest.
float linearLight(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
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

// `named`: the file as the user calls it; `file`: the one beside it that is written first.
void writeExr(const fs::path& named, const fs::path& file, const Image& image) {
  const auto out = OIIO::ImageOutput::create("exr");
  if (!out) throw InvalidInput(named.string() + ": cannot be written: " + reason(nullptr));
  OIIO::ImageSpec spec(image.width, image.height, static_cast<int>(image.channels.size()), OIIO::TypeDesc::FLOAT);
  spec.channelnames = image.channels;
  const auto alpha = std::ranges::find(image.channels, "A");
  spec.alpha_channel = alpha == image.channels.end() ? -1 : static_cast<int>(alpha - image.channels.begin());
  spec.attribute("compression", "zip");
  spec.attribute("DateTime", "");  // else the time of writing: the same picture is to be the same bytes
  if (!out->open(file.string(), spec) || !out->write_image(OIIO::TypeDesc::FLOAT, image.values.data()) || !out->close())
    throw InvalidInput(named.string() + ": cannot be written: " + reason(out.get()));
}

constexpr int kMostWidth = 8192, kMostHeight = 4096;  // of a picture that is read

}  // namespace

Image readRadiances(const fs::path& file) {
  const std::string extension = lowered(file.extension().string());
  if (extension != ".exr" && extension != ".hdr")
    throw InvalidInput(file.string() + ": has the extension \"" + file.extension().string() +
                       "\": a picture of radiances must be .exr or .hdr");
  if (!fs::is_regular_file(file)) throw InvalidInput(file.string() + ": must be a file that can be read");
  const auto refuse = [&](std::string why) {
    why.resize(std::min(why.find('\n'), why.size()));
    throw InvalidInput(file.string() + ": cannot be read: " + (why.empty() ? "OpenImageIO gives no reason" : why));
  };
  const auto in = OIIO::ImageInput::open(file.string());
  if (!in) refuse(OIIO::geterror());
  const OIIO::ImageSpec& spec = in->spec();
  if (spec.width < 1 || spec.width > kMostWidth || spec.height < 1 || spec.height > kMostHeight || spec.depth != 1 ||
      spec.nchannels < 1 || spec.nchannels > 64)
    throw InvalidInput(file.string() + ": has " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                       " pixels of " + std::to_string(spec.nchannels) + " channels: must be at most " +
                       std::to_string(kMostWidth) + " x " + std::to_string(kMostHeight) + " of 64");
  Image image{.width = spec.width, .height = spec.height, .channels = spec.channelnames, .values = {}};
  image.values.resize(image.at(0, image.height, 0));
  if (!in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, image.values.data())) refuse(in->geterror());
  return image;
}

void requirePictureName(const fs::path& file) {
  const std::string extension = lowered(file.extension().string());
  if (extension != ".png" && extension != ".exr")
    throw InvalidInput(file.string() + ": has the extension \"" + file.extension().string() +
                       "\": a picture's must be .exr or .png");
  requireWritable(file);
}

void writeImage(const fs::path& file, const Image& image, float exposure) {
  assert(image.values.size() == image.at(0, image.height, 0));
  requirePictureName(file);
  if (lowered(file.extension().string()) == ".png")
    writeWhole(file, pngBytes(image, exposure));
  else
    writeWhole(file, [&](const fs::path& temporary) { writeExr(file, temporary, image); });
}

Image readImage(const fs::path& file, ImageValues values) {
  const auto refuse = [&](const std::string& why) { throw InvalidInput(file.string() + ": cannot be read: " + why); };
  std::error_code failure;
  if (!fs::is_regular_file(file, failure)) refuse("there is no such file");
  OIIO::ImageSpec as_stored;
  as_stored.attribute("oiio:UnassociatedAlpha", 1);  // else colours would come multiplied by alpha
  const auto in = OIIO::ImageInput::open(file.string(), &as_stored);
  if (!in) refuse(reason(nullptr));
  const OIIO::ImageSpec spec = in->spec();
  if (spec.width < 1 || spec.height < 1 || spec.width > kLargestImage || spec.height > kLargestImage || spec.depth > 1)
    refuse("it must be a flat image of at most 8192 x 8192 pixels");
  if (spec.nchannels < 1 || spec.nchannels > 4) refuse("it must have one to four channels");
  Image image{.width = spec.width, .height = spec.height, .channels = {}, .values = {}};
  const auto channels = static_cast<std::size_t>(spec.nchannels);
  const bool has_alpha = spec.alpha_channel >= 0 || channels == 2 || channels == 4;
  const std::size_t alpha = !has_alpha                ? channels
                            : spec.alpha_channel >= 0 ? static_cast<std::size_t>(spec.alpha_channel)
                                                      : channels - 1;
  const std::size_t colours = channels - (has_alpha ? 1 : 0);
  for (std::size_t c = 0, colour = 0; c < channels; ++c)
    image.channels.push_back(c == alpha ? "A" : colours == 3 ? std::string(1, "RGB"[colour++]) : "Y");
  image.values.resize(image.at(0, image.height, 0));
  if (!in->read_image(0, 0, 0, -1, OIIO::TypeDesc::FLOAT, image.values.data())) {
    std::string why = in->geterror();
    why.resize(std::min(why.find('\n'), why.size()));
    refuse(why);
  }
  const bool decode = values == ImageValues::linear && !spec.format.is_floating_point();
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    float& value = image.values[i];
    if (!std::isfinite(value)) refuse("it holds a value that is not a finite number");
    if (decode && i % channels != alpha) value = linearLight(value);
  }
  return image;
}

std::string pngBytes(const Image& image, float exposure) {
  const std::vector<std::size_t> shown = shownChannels(image);
  std::vector<std::uint8_t> codes;
  codes.reserve(image.values.size());
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (const std::size_t channel : shown)
        codes.push_back(sRgbCode(exposure * image.values[image.at(x, y, channel)]));

  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const auto out = OIIO::ImageOutput::create("png");
  if (!out || !out->set_ioproxy(&memory)) throw std::runtime_error("no PNG can be made: " + reason(out.get()));
  OIIO::ImageSpec spec(image.width, image.height, static_cast<int>(shown.size()), OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  if (!out->open("picture.png", spec) || !out->write_image(OIIO::TypeDesc::UINT8, codes.data()) || !out->close())
    throw std::runtime_error("no PNG can be made: " + reason(out.get()));
  return {bytes.begin(), bytes.end()};
}

}  // namespace sunfleck
