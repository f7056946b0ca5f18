#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace sunfleck {

// A picture of linear radiances, rows from top to bottom, channels interleaved.
struct Image {
  int width = 0, height = 0;          // [pixel]
  std::vector<std::string> channels;  // "R", "G", "B", "Y", ...
  std::vector<float> values;          // [W m^-2 sr^-1 per W m^-2 of sun], width * height * channels

  std::size_t at(int x, int y, std::size_t channel) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
               channels.size() +
           channel;
  }
};

}  // namespace sunfleck
