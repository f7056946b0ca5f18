#include "plants/detail/part_opacity.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "core/require.hpp"
#include "plants/detail/input_file.hpp"

namespace sunfleck::detail {

std::shared_ptr<const LeafMask> maskOf(const Opacity& opacity, const ImageReader& read_image,
                                       const std::string& source) {
  if (!read_image)
    throw InvalidInput(source + ": has leaves that a mask cuts out (" + shown(opacity.key) +
                       "), and no images are read here");
  const Image image = read_image(opacity.image, opacity.bytes);
  const std::size_t channels = image.channels.size(), pixels = image.values.size() / channels;
  const auto alpha =
      static_cast<std::size_t>(std::find(image.channels.begin(), image.channels.end(), "A") - image.channels.begin());
  const auto isOne = [&](std::size_t pixel) { return image.values[pixel * channels + alpha] == 1.f; };
  bool use_alpha = false;
  for (std::size_t pixel = 0; alpha < channels && pixel < pixels && !use_alpha; ++pixel) use_alpha = !isOne(pixel);
  if (opacity.by_alpha && !use_alpha && opacity.factor >= opacity.least) return nullptr;
  if (opacity.moved)
    throw InvalidInput(source + ": " + shown(opacity.key) + ": must be without -s and -o, which move the mask");
  auto mask = std::make_shared<LeafMask>(LeafMask{.width = image.width, .height = image.height, .opaque = {}});
  mask->opaque.reserve(pixels);
  const std::size_t colours = std::min<std::size_t>(alpha, channels >= 3 ? 3 : 1);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    const float* const values = image.values.data() + pixel * channels;
    const float brightness =
        std::accumulate(values, values + colours, 0.f) / static_cast<float>(std::max<std::size_t>(colours, 1));
    const float there = use_alpha ? values[alpha] : opacity.by_alpha ? 1.f : brightness;
    mask->opaque.push_back(opacity.factor * there >= opacity.least);
  }
  if (opacity.by_alpha && std::ranges::find(mask->opaque, 0) == mask->opaque.end()) return nullptr;
  return mask;
}

}  // namespace sunfleck::detail
