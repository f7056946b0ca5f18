#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "render/compare/picture_difference.hpp"
#include "render/false_colour.hpp"
#include "render/tone_mapping.hpp"

namespace sunfleck {
namespace {

constexpr int kGlyphWidth = 5, kGlyphHeight = 7;
constexpr int kMargin = 6, kBarWidth = 12, kTickGap = 3, kTextLength = 5;  // [dot], the last in glyphs
constexpr int kTicks = 5;
constexpr float kPaper = 0.f, kInk = 0.7f;  // light [1]

// The glyphs that numbers need: rows from the top, the leftmost dot the highest of five bits.
struct Glyph {
  char character;
  std::array<unsigned char, kGlyphHeight> rows;
};
constexpr std::array kGlyphs{Glyph{'0', {14, 17, 19, 21, 25, 17, 14}}, Glyph{'1', {4, 12, 4, 4, 4, 4, 14}},
                             Glyph{'2', {14, 17, 1, 2, 4, 8, 31}},     Glyph{'3', {31, 2, 4, 2, 1, 17, 14}},
                             Glyph{'4', {2, 6, 10, 18, 31, 2, 2}},     Glyph{'5', {31, 16, 30, 1, 1, 17, 14}},
                             Glyph{'6', {6, 8, 16, 30, 17, 17, 14}},   Glyph{'7', {31, 1, 2, 4, 8, 8, 8}},
                             Glyph{'8', {14, 17, 17, 14, 17, 17, 14}}, Glyph{'9', {14, 17, 17, 15, 1, 2, 12}},
                             Glyph{'.', {0, 0, 0, 0, 0, 12, 12}},      Glyph{'-', {0, 0, 0, 31, 0, 0, 0}},
                             Glyph{'+', {0, 4, 4, 31, 4, 4, 0}},       Glyph{'e', {0, 0, 14, 17, 31, 16, 14}},
                             Glyph{'%', {24, 25, 2, 4, 8, 19, 3}}};

// Paints squares of light on a picture of three channels.
class Painter {
 public:
  //   dot  side of a glyph's dot [pixel]
  Painter(Image& image, int dot) : image_(image), dot_(dot) {}

  void fill(int left, int top, int right, int bottom, const glm::vec3& light) {
    for (int y = std::max(top, 0); y < std::min(bottom, image_.height); ++y)
      for (int x = std::max(left, 0); x < std::min(right, image_.width); ++x)
        for (int band = 0; band < 3; ++band)
          image_.values[image_.at(x, y, static_cast<std::size_t>(band))] = light[band];
  }

  void text(int left, int top, std::string_view characters) {
    for (const char c : characters) {
      const auto glyph = std::ranges::find(kGlyphs, c, &Glyph::character);
      if (glyph != kGlyphs.end())
        for (int row = 0; row < kGlyphHeight; ++row)
          for (int column = 0; column < kGlyphWidth; ++column)
            if (glyph->rows[static_cast<std::size_t>(row)] >> (kGlyphWidth - 1 - column) & 1)
              fill(left + column * dot_, top + row * dot_, left + (column + 1) * dot_, top + (row + 1) * dot_,
                   glm::vec3(kInk));
      left += (kGlyphWidth + 1) * dot_;
    }
  }

 private:
  Image& image_;
  int dot_;
};

}  // namespace

Image withColourBar(const Image& false_colours, float high, bool percent) {
  const int dot = std::max(1, false_colours.height / 300);
  const int added = dot * (2 * kMargin + kBarWidth + kTickGap + kTextLength * (kGlyphWidth + 1));
  Image image{
      .width = false_colours.width + added, .height = false_colours.height, .channels = {"R", "G", "B"}, .values = {}};
  image.values.assign(image.at(0, image.height, 0), kPaper);
  for (int y = 0; y < image.height; ++y)
    std::copy_n(&false_colours.values[false_colours.at(0, y, 0)], false_colours.width * 3,
                &image.values[image.at(0, y, 0)]);
  Painter painter(image, dot);
  const int left = false_colours.width + kMargin * dot, right = left + kBarWidth * dot;
  const int top = std::min(kMargin * dot, image.height / 4), bottom = image.height - top;
  for (int y = top; y < bottom; ++y) {
    const glm::vec3 code = falseColour(1.f - (static_cast<float>(y - top) + 0.5f) / static_cast<float>(bottom - top));
    painter.fill(left, y, right, y + 1,
                 {tone_mapping::srgbLight(code.x), tone_mapping::srgbLight(code.y), tone_mapping::srgbLight(code.z)});
  }
  // As many numbers as there is room for.
  const int ticks = std::clamp((bottom - top) / (2 * kGlyphHeight * dot), 2, kTicks);
  for (int i = 0; i < ticks; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(ticks - 1);
    const int y = bottom - static_cast<int>(share * static_cast<float>(bottom - top)) - (i == ticks - 1 ? 0 : dot);
    painter.fill(right, y, right + (kTickGap - 1) * dot, y + dot, glm::vec3(kInk));
    const int text_top = std::clamp(y - kGlyphHeight / 2 * dot, 0, std::max(0, image.height - kGlyphHeight * dot));
    painter.text(right + kTickGap * dot, text_top,
                 percent ? fmt::format("{:.3g}%", 100.f * share * high) : fmt::format("{:.2g}", share * high));
  }
  return image;
}

}  // namespace sunfleck
