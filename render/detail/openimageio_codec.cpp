#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <stdexcept>

#include "render/detail/image_codec.hpp"

namespace sunfleck::detail {
namespace {

[[noreturn]] void fail(std::string reason) {
  reason.resize(std::min(reason.find('\n'), reason.size()));
  throw std::runtime_error(reason.empty() ? "OpenImageIO gives no reason" : reason);
}

class OpenImageIoCodec final : public ImageCodec {
 public:
  Image read(const std::filesystem::path& file, std::string_view bytes,
             const std::function<void(const StoredImage&)>& check) const override {
    OIIO::ImageSpec as_stored;
    as_stored.attribute("oiio:UnassociatedAlpha", 1);  // else colours would come multiplied by alpha
    OIIO::Filesystem::IOMemReader memory(const_cast<char*>(bytes.data()), bytes.size());
    const auto in = bytes.empty() ? OIIO::ImageInput::open(file.string(), &as_stored)
                                  : OIIO::ImageInput::create(file.extension().string().substr(1));
    if (!in) fail(OIIO::geterror());
    if (OIIO::ImageSpec of_memory;
        !bytes.empty() && (!in->set_ioproxy(&memory) || !in->open(file.string(), of_memory, as_stored)))
      fail(in->geterror());
    const OIIO::ImageSpec& spec = in->spec();
    check({.width = spec.width,
           .height = spec.height,
           .depth = spec.depth,
           .channels = spec.channelnames,
           .alpha_channel = spec.alpha_channel,
           .floating = spec.format.is_floating_point()});
    Image image{.width = spec.width, .height = spec.height, .channels = spec.channelnames, .values = {}};
    image.values.resize(image.at(0, image.height, 0));
    if (!in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, image.values.data())) fail(in->geterror());
    return image;
  }

  void writeExr(const std::filesystem::path& file, const Image& image) const override {
    const auto out = OIIO::ImageOutput::create("exr");
    if (!out) fail(OIIO::geterror());
    OIIO::ImageSpec spec(image.width, image.height, static_cast<int>(image.channels.size()), OIIO::TypeDesc::FLOAT);
    spec.channelnames = image.channels;
    const auto alpha = std::ranges::find(image.channels, "A");
    spec.alpha_channel = alpha == image.channels.end() ? -1 : static_cast<int>(alpha - image.channels.begin());
    spec.attribute("compression", "zip");
    spec.attribute("DateTime", "");  // else the time of writing: the same picture is to be the same bytes
    if (!out->open(file.string(), spec) || !out->write_image(OIIO::TypeDesc::FLOAT, image.values.data()) ||
        !out->close())
      fail(out->geterror());
  }

  std::string png(int width, int height, int channels, std::span<const std::uint8_t> codes) const override {
    OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    return pngOf(spec, codes.data());
  }

  std::string linearPng(int width, int height, int channels, std::span<const std::uint16_t> codes) const override {
    OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::UINT16);
    spec.attribute("oiio:ColorSpace", "linear");
    spec.attribute("oiio:UnassociatedAlpha", 1);
    if (channels == 2 || channels == 4) spec.alpha_channel = channels - 1;
    return pngOf(spec, codes.data());
  }

 private:
  // Of values in the spec's format.
  static std::string pngOf(const OIIO::ImageSpec& spec, const void* codes) {
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    const auto out = OIIO::ImageOutput::create("png");
    if (!out) fail(OIIO::geterror());
    if (!out->set_ioproxy(&memory) || !out->open("picture.png", spec) || !out->write_image(spec.format, codes) ||
        !out->close())
      fail(out->geterror());
    return {bytes.begin(), bytes.end()};
  }
};

}  // namespace
}  // namespace sunfleck::detail

extern "C" const sunfleck::detail::ImageCodec* sunfleckImageCodec() {
  static const sunfleck::detail::OpenImageIoCodec codec;
  return &codec;
}
