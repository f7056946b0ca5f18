#include "apps/view/leaf_thumbnails.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>

#include "render/tone_mapping.hpp"

namespace sunfleck::view {
namespace {

glm::u8vec4 codeOf(const glm::vec3& light) {
  const Display display(1.f);
  glm::u8vec4 code(255);
  for (int band = 0; band < kBands; ++band)
    code[band] = static_cast<std::uint8_t>(std::lround(255.f * display.code(std::clamp(light[band], 0.f, 1.f))));
  return code;
}

glm::u8vec4 greyOf(float share) {
  const auto code = static_cast<std::uint8_t>(std::lround(255.f * std::clamp(share, 0.f, 1.f)));
  return {code, code, code, 255};
}

constexpr std::size_t kMostSamples = 4;  // along each side of a pixel: maps are shown while a person drags

// The mean of `value(place)` over some of each pixel's places, as `shown` makes colours of it.
template <typename Value, typename Show>
Thumbnail reduced(int width, int height, int longest, const Value& value, const Show& shown) {
  const double scale = std::max(1., static_cast<double>(std::max(width, height)) / longest);
  const auto fewer = [&](int side) { return std::clamp(static_cast<int>(std::lround(side / scale)), 1, side); };
  Thumbnail small{.width = fewer(width), .height = fewer(height), .colours = {}};
  small.colours.reserve(static_cast<std::size_t>(small.width) * static_cast<std::size_t>(small.height));
  const auto first = [](int pixel, int pixels, int places) {
    return static_cast<std::size_t>(std::int64_t{pixel} * places / pixels);
  };
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x) {
      auto sum = value(0);
      sum = {};
      std::size_t places = 0;
      const std::size_t top = first(y, small.height, height), bottom = first(y + 1, small.height, height);
      const std::size_t left = first(x, small.width, width), right = first(x + 1, small.width, width);
      const std::size_t down = (bottom - top + kMostSamples - 1) / kMostSamples;
      const std::size_t along = (right - left + kMostSamples - 1) / kMostSamples;
      for (std::size_t row = top; row < bottom; row += down)
        for (std::size_t at = left; at < right; at += along, ++places)
          sum += value(row * static_cast<std::size_t>(width) + at);
      small.colours.push_back(shown(sum / static_cast<float>(places)));
    }
  return small;
}

}  // namespace

Thumbnail thumbnailOf(const LeafTexture& texture, LeafImagePart part, int longest) {
  if (part == LeafImagePart::colour)
    return reduced(
        texture.width, texture.height, longest, [&](std::size_t place) { return texture.colour[place]; }, codeOf);
  return reduced(
      texture.width, texture.height, longest,
      [&](std::size_t place) { return texture.alpha.empty() ? 1.f : texture.alpha[place]; }, greyOf);
}

Thumbnail thumbnailOf(const LeafMaps& maps, LeafMapPart part, int longest) {
  const auto value = [&](std::size_t place) {
    const LeafPlace& of = maps.places[place];
    if (part == LeafMapPart::transmittance) return of.transmittance;
    return of.faces[part == LeafMapPart::upper_reflectance ? 0 : 1].reflectance;
  };
  return reduced(maps.width, maps.height, longest, value, codeOf);
}

template <typename Images, typename Part>
const LeafThumbnails::Uploaded& LeafThumbnails::of(const std::shared_ptr<const Images>& images, Part part) {
  std::erase_if(entries_, [](const Entry& entry) { return entry.of.expired(); });
  for (const Entry& entry : entries_)
    if (entry.part == static_cast<int>(part) && entry.of.lock() == images) return *entry.uploaded;
  ++made_;
  return *entries_.emplace_back(Entry{images, static_cast<int>(part), upload_(thumbnailOf(*images, part, longest_))})
              .uploaded;
}

template const LeafThumbnails::Uploaded& LeafThumbnails::of(const std::shared_ptr<const LeafTexture>&, LeafImagePart);
template const LeafThumbnails::Uploaded& LeafThumbnails::of(const std::shared_ptr<const LeafMaps>&, LeafMapPart);

std::shared_ptr<const LeafThumbnails::Uploaded> uploadedThumbnail(const Thumbnail& thumbnail) {
  unsigned name = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &name);
  const std::shared_ptr<const LeafThumbnails::Uploaded> uploaded(
      new LeafThumbnails::Uploaded{.name = name, .width = thumbnail.width, .height = thumbnail.height},
      [](const LeafThumbnails::Uploaded* gone) {
        glDeleteTextures(1, &gone->name);
        delete gone;
      });
  glTextureStorage2D(name, 1, GL_RGBA8, thumbnail.width, thumbnail.height);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTextureSubImage2D(name, 0, 0, 0, thumbnail.width, thumbnail.height, GL_RGBA, GL_UNSIGNED_BYTE,
                      thumbnail.colours.data());
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return uploaded;
}

}  // namespace sunfleck::view
