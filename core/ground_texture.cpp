#include "core/ground_texture.hpp"

#include <cmath>
#include <cstddef>
#include <string>

#include "core/require.hpp"

namespace sunfleck {
namespace {

struct Neighbours {
  int before, after;  // pixels
  float share;        // of the way between their centres
};

Neighbours neighbours(double at, int count) {
  const double turns = (at - 0.5) / count;
  const double within = (turns - std::floor(turns)) * count;
  const double low = std::floor(within);
  const int before = static_cast<int>(low) % count;
  return {before, (before + 1) % count, static_cast<float>(within - low)};
}

}  // namespace

float GroundTexture::at(double x, double y) const {
  const double pixel = double{size} / width;
  const Neighbours across = neighbours(x / pixel, width), up = neighbours(y / pixel, height);
  const auto row = [&](int from_below) {
    const float* const pixels =
        albedo.data() + static_cast<std::size_t>(height - 1 - from_below) * static_cast<std::size_t>(width);
    return pixels[across.before] + across.share * (pixels[across.after] - pixels[across.before]);
  };
  const float below = row(up.before), above = row(up.after);
  return below + up.share * (above - below);
}

void validate(const GroundTexture& texture) {
  require(texture.width > 0, "ground texture's width", texture.width, "at least 1");
  require(texture.height > 0, "ground texture's height", texture.height, "at least 1");
  require(texture.albedo.size() == static_cast<std::size_t>(texture.width) * static_cast<std::size_t>(texture.height),
          "number of the ground texture's pixels", texture.albedo.size(), "width * height");
  require(texture.size >= 1e-3f && texture.size <= 1e6f, "ground texture_size", texture.size, "in [1e-3, 1e6] m");
  for (const float albedo : texture.albedo)
    require(albedo >= 0.f && albedo <= 1.f, "albedo in the ground's texture", albedo, "in [0, 1]");
}

}  // namespace sunfleck
