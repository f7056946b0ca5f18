#include "sky/sky_models.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "core/require.hpp"

namespace sunfleck {
namespace {

constexpr int kOvercastRows = 180;  // of half a degree: the irradiance of tilted planes is right to 1e-5

// Where the image keeps red, green and blue.
std::array<std::size_t, kBands> channelsOf(const Image& image) {
  std::array<std::size_t, kBands> found{};
  const std::array<const char*, kBands> names{"R", "G", "B"};
  for (std::size_t band = 0; band < kBands; ++band) {
    const auto at = std::find(image.channels.begin(), image.channels.end(), names[band]);
    if (at == image.channels.end()) return {};
    found[band] = static_cast<std::size_t>(at - image.channels.begin());
  }
  return found;
}

}  // namespace

SkyMap withIrradiance(const SkyMap& sky, const glm::dvec3& irradiance) {
  glm::dvec3 factors(0.);
  for (int band = 0; band < kBands; ++band) {
    require(irradiance[band] >= 0. && irradiance[band] <= 1e6, "irradiance of the sky", irradiance[band],
            "in [0, 1e6]");
    if (irradiance[band] == 0.) continue;
    require(sky.irradiance()[band] > 0., "irradiance that the sky's own radiance gives", sky.irradiance()[band],
            "above 0 in a band that is to have some");
    factors[band] = irradiance[band] / sky.irradiance()[band];
  }
  return sky.scaled(factors);
}

SkyMap uniformSky(const glm::dvec3& irradiance) {
  return withIrradiance(SkyMap(1, 1, 0.f, {glm::vec3(1.f)}), irradiance);
}

// A cell's mean over its solid angle is that of the cosines at its borders.
SkyMap overcastSky(const glm::dvec3& irradiance) {
  std::vector<glm::vec3> radiance;
  for (int row = 0; row < kOvercastRows; ++row) {
    const double step = 0.5 * std::numbers::pi / kOvercastRows;
    radiance.emplace_back((1. + std::cos(row * step) + std::cos((row + 1) * step)) / 3.);
  }
  return withIrradiance(SkyMap(kOvercastRows, 1, 0.f, std::move(radiance)), irradiance);
}

ImageSky imageSky(const Image& image, double rotation) {
  require(image.height >= 2 && image.height % 2 == 0, "height of the sky's image", image.height,
          "even: rows that end at "
          "the horizon");
  require(!image.channels.empty(), "channels of the sky's image", image.channels.size(), "at least 1");
  require(std::abs(rotation) <= 90., "rotation of the sky's image", rotation, "in [-90, 90] rad");
  const std::array<std::size_t, kBands> channels = channelsOf(image);
  std::vector<glm::vec3> radiance;
  std::size_t negative_values = 0;
  for (int row = 0; row < image.height / 2; ++row)
    for (int column = image.width - 1; column >= 0; --column) {
      glm::vec3& value = radiance.emplace_back();
      for (int band = 0; band < kBands; ++band) {
        const float stored = image.values[image.at(column, row, channels[static_cast<std::size_t>(band)])];
        require(std::isfinite(stored), "value of the sky's image", stored, "finite");
        negative_values += stored < 0.f;
        value[band] = std::max(stored, 0.f);
      }
    }
  return {.sky = SkyMap(image.height / 2, image.width, static_cast<float>(rotation - std::numbers::pi),
                        std::move(radiance)),
          .negative_values = negative_values};
}

}  // namespace sunfleck
