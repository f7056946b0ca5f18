#include "render/leaf_texture_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/require.hpp"
#include "render/image_file.hpp"

namespace sunfleck {
namespace fs = std::filesystem;

std::shared_ptr<const LeafTexture> readLeafTexture(const fs::path& file, float most_colour) {
  const Image image = readOpacity(file, {});
  const auto channel = [&](const char* name) {
    return static_cast<std::size_t>(std::ranges::find(image.channels, name) - image.channels.begin());
  };
  const std::size_t channels = image.channels.size(), alpha = channel("A");
  const std::size_t first = channel("Y") < channels ? channel("Y") : channel("R");
  const std::size_t bands = channel("Y") < channels ? 1 : kBands;
  if (first == channels) throw InvalidInput(file.string() + ": has no colours: must have one or three");
  LeafTexture texture{.file = file, .width = image.width, .height = image.height, .colour = {}, .alpha = {}};
  texture.colour.reserve(image.values.size() / channels);
  for (std::size_t at = 0; at < image.values.size(); at += channels) {
    const float* values = image.values.data() + at;
    texture.colour.push_back(bands == 1 ? glm::vec3(values[first])
                                        : glm::vec3(values[first], values[channel("G")], values[channel("B")]));
    if (alpha < channels) texture.alpha.push_back(values[alpha]);
  }
  validate(texture, most_colour, file.string());
  return std::make_shared<const LeafTexture>(std::move(texture));
}

void writeLeafTexture(const fs::path& file, const LeafTexture& texture) {
  Image image{.width = texture.width, .height = texture.height, .channels = {"R", "G", "B"}, .values = {}};
  if (!texture.alpha.empty()) image.channels.emplace_back("A");
  image.values.reserve(texture.colour.size() * image.channels.size());
  for (std::size_t i = 0; i < texture.colour.size(); ++i) {
    for (int band = 0; band < kBands; ++band) image.values.push_back(texture.colour[i][band]);
    if (!texture.alpha.empty()) image.values.push_back(texture.alpha[i]);
  }
  writeValues(file, image);
}

}  // namespace sunfleck
