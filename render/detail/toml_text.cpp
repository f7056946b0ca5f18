#include "render/detail/toml_text.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <string_view>

#include "core/require.hpp"

namespace sunfleck::detail {

std::string tomlText(const std::filesystem::path& file) {
  constexpr int kMostDots = 32;
  if (!std::filesystem::is_regular_file(file)) throw InvalidInput(file.string() + ": must be a file that can be read");
  std::ifstream in(file, std::ios::binary);
  std::string text(std::istreambuf_iterator<char>(in), {});
  if (!in) throw InvalidInput(file.string() + ": cannot be read");
  int line = 1, dots = 0;
  for (const char c : text) {
    line += c == '\n';
    if (std::string_view(",=[]{}#\n").find(c) != std::string_view::npos) dots = 0;
    if (c == '.' && ++dots > kMostDots)
      throw InvalidInput(
          fmt::format("{}:{}: more than {} dots on end: must be a number or a key", file.string(), line, kMostDots));
  }
  return text;
}

}  // namespace sunfleck::detail
