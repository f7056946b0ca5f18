#include "render/compare/picture_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/csv_field.hpp"

namespace sunfleck {
namespace {

constexpr int kGap = 4;                // between pictures [pixel]
constexpr double kShownShare = 0.995;  // of the first picture's differences lie within the colours
constexpr std::size_t kColours = 3;

void copy(const Image& from, Image& to, int left, int top) {
  for (int y = 0; y < from.height; ++y)
    for (int x = 0; x < from.width; ++x)
      for (std::size_t band = 0; band < kColours; ++band)
        to.values[to.at(left + x, top + y, band)] = from.values[from.at(x, y, band)];
}

Image shown(const Image& picture, const Display& display) {
  Image light{.width = picture.width, .height = picture.height, .channels = {"R", "G", "B"}, .values = {}};
  for (std::size_t i = 0; i < picture.values.size(); i += picture.channels.size())
    for (std::size_t band = 0; band < kColours; ++band)
      light.values.push_back(tone_mapping::srgbLight(display.code(picture.values[i + band])));
  return light;
}

float largestShown(Image differences) {
  const auto rank = differences.values.begin() +
                    static_cast<std::ptrdiff_t>(kShownShare * static_cast<double>(differences.values.size() - 1));
  std::nth_element(differences.values.begin(), rank, differences.values.end());
  return *rank > 0.f ? *rank : *std::ranges::max_element(differences.values);
}

}  // namespace

Image pictureSheet(const Image& reference, const std::vector<ComparedPicture>& pictures, const Display& display) {
  const int columns = static_cast<int>(pictures.size()) + 1;
  std::vector<Image> differences;
  for (const ComparedPicture& of : pictures) differences.push_back(differencePicture(of.picture, reference));
  const float high = differences.empty() ? 0.f : largestShown(differences.front());
  Image last;
  if (!differences.empty()) last = withColourBar(inFalseColours(differences.back(), high), high, false);

  const int bar = std::max(0, last.width - reference.width);
  Image sheet{.width = columns * (reference.width + kGap) - kGap + bar,
              .height = 2 * reference.height + kGap,
              .channels = {"R", "G", "B"},
              .values = {}};
  sheet.values.resize(sheet.at(0, sheet.height, 0));
  copy(shown(reference, display), sheet, 0, 0);
  for (int column = 1; column < columns; ++column) {
    const auto i = static_cast<std::size_t>(column - 1);
    const int left = column * (reference.width + kGap);
    copy(shown(pictures[i].picture, display), sheet, left, 0);
    copy(column == columns - 1 ? last : inFalseColours(differences[i], high), sheet, left, reference.height + kGap);
  }
  return sheet;
}

std::string pictureErrorHeader() {
  return "scene,model,rms_without_noise,standard_error,rms,noise_of_reference,bias\n";
}

std::string pictureErrorRows(const std::string& scene, const std::vector<ComparedPicture>& pictures) {
  std::string rows;
  for (const ComparedPicture& of : pictures)
    rows += fmt::format("{},{},{:.6g},{:.3g},{:.6g},{:.6g},{:.6g}\n", csvField(scene), of.model, of.error.without_noise,
                        of.error.standard_error, of.error.rms, of.error.noise, of.error.bias);
  return rows;
}

}  // namespace sunfleck
