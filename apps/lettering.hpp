#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace sunfleck::apps {

// A picture of 8-bit colours, rows from the top.
struct Sheet {
  int width = 0, height = 0;          // [pixel]
  std::vector<std::uint8_t> colours;  // red, green and blue of each pixel
};

// Letters of 5 x 8 pixels, a blank column after each, where no font can be relied on.
inline constexpr int kLetterWidth = 6, kLetterHeight = 8;

// Writes dark letters of `size` times their pixels with the upper left corner at (x, y); what lies beyond the sheet is
// left out, and a byte that is no printable ASCII is a question mark.
void write(Sheet& sheet, std::string_view text, int x, int y, int size);

}  // namespace sunfleck::apps
