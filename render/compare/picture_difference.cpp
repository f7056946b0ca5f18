#include "render/compare/picture_difference.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "render/false_colour.hpp"
#include "render/tone_mapping.hpp"

namespace sunfleck {
namespace {

constexpr std::size_t kColours = 3;

void requireAlike(const Image& picture, const Image& reference) {
  const auto coloured = [](const Image& image) {
    return image.channels.size() >= kColours && image.channels[0] == "R" && image.channels[1] == "G" &&
           image.channels[2] == "B";
  };
  if (picture.width != reference.width || picture.height != reference.height || !coloured(picture) ||
      !coloured(reference))
    throw std::invalid_argument("difference of pictures: must be of one size, with channels R, G and B");
}

// Visits each pixel: its number and how much of it the picture covers.
template <typename Visit>
void forPixels(const Image& picture, const Visit& visit) {
  const std::size_t channels = picture.channels.size();
  const auto found = std::ranges::find(picture.channels, "A");
  const auto alpha = static_cast<std::size_t>(found - picture.channels.begin());
  const std::size_t pixels = static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel)
    visit(pixel, alpha < channels ? double{picture.values[pixel * channels + alpha]} : 1.);
}

double valueOf(const Image& image, std::size_t pixel, std::size_t band) {
  return double{image.values[pixel * image.channels.size() + band]};
}

}  // namespace

PictureError pictureError(const Image& picture, const Image& reference, const Image* standard_error) {
  requireAlike(picture, reference);
  if (standard_error) requireAlike(picture, *standard_error);
  double squares = 0., noise = 0., variance = 0., brightness = 0., sum = 0., of_reference = 0.;
  forPixels(picture, [&](std::size_t pixel, double coverage) {
    for (std::size_t band = 0; band < kColours; ++band) {
      const double a = valueOf(picture, pixel, band), b = valueOf(reference, pixel, band), d = (a - b) * (a - b);
      const double s = standard_error ? std::pow(valueOf(*standard_error, pixel, band), 2) : 0.;
      squares += coverage * d;
      noise += coverage * s;
      variance += coverage * coverage * std::max(0., 4. * d * s - 2. * s * s);
      brightness += coverage * (b * b - s);
      sum += coverage * a;
      of_reference += coverage * b;
    }
  });
  if (!(brightness > 0.) || !(of_reference > 0.)) return {};
  PictureError error{.rms = std::sqrt(squares / brightness),
                     .noise = std::sqrt(noise / brightness),
                     .without_noise = std::sqrt(std::max(0., squares - noise) / brightness),
                     .bias = sum / of_reference - 1.};
  const double of_square = std::sqrt(variance) / brightness;
  error.standard_error = of_square / std::max(2. * error.without_noise, std::sqrt(of_square));
  if (of_square == 0.) error.standard_error = 0.;
  return error;
}

Image differencePicture(const Image& picture, const Image& reference) {
  requireAlike(picture, reference);
  Image difference{.width = picture.width, .height = picture.height, .channels = {"Y"}, .values = {}};
  forPixels(picture, [&](std::size_t pixel, double coverage) {
    double squares = 0.;
    for (std::size_t band = 0; band < kColours; ++band)
      squares += std::pow(valueOf(picture, pixel, band) - valueOf(reference, pixel, band), 2) / kColours;
    difference.values.push_back(coverage > 0. ? static_cast<float>(std::sqrt(squares)) : 0.f);
  });
  return difference;
}

Image inFalseColours(const Image& values, float high) {
  Image colours{.width = values.width, .height = values.height, .channels = {"R", "G", "B"}, .values = {}};
  colours.values.reserve(values.values.size() * kColours);
  for (const float value : values.values) {
    const glm::vec3 code = falseColour(high > 0.f ? value / high : 0.f);
    for (int band = 0; band < 3; ++band) colours.values.push_back(tone_mapping::srgbLight(code[band]));
  }
  return colours;
}

}  // namespace sunfleck
