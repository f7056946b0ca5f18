#include "plants/detail/input_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "core/require.hpp"

namespace sunfleck::detail {
namespace fs = std::filesystem;

std::string readWhole(const fs::path& path) {
  const auto refuse = [&](const std::string& reason) {
    throw InvalidInput(shown(path.string()) + ": cannot be read: " + reason);
  };
  std::error_code failure;
  const fs::file_status status = fs::status(path, failure);
  if (status.type() == fs::file_type::not_found) refuse("there is no such file");
  if (failure) refuse(failure.message());
  if (fs::is_directory(status)) refuse("it is a folder");
  if (!fs::is_regular_file(status)) refuse("it is not a regular file");
  std::ifstream in(path, std::ios::binary);
  if (!in) refuse(std::strerror(errno));
  const auto size = fs::file_size(path, failure);
  if (failure) refuse(failure.message());
  if (size == 0) refuse("it is empty");
  std::string content(size, '\0');
  in.read(content.data(), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(in.gcount()) != size) refuse("it ended while it was read");
  return content;
}

std::string shown(std::string_view text) {
  constexpr std::size_t kMost = 200;
  std::string clean;
  for (std::size_t i = 0; i < std::min(text.size(), kMost);) {
    const auto first = static_cast<unsigned char>(text[i]);
    const std::size_t length = first < 0x80                    ? 1
                               : first >= 0xc2 && first < 0xe0 ? 2
                               : first >= 0xe0 && first < 0xf0 ? 3
                               : first >= 0xf0 && first < 0xf5 ? 4
                                                               : 0;
    const std::string_view character = text.substr(i, length);
    const bool whole = length > 0 && character.size() == length &&
                       std::ranges::all_of(character.substr(1), [](unsigned char c) { return (c & 0xc0) == 0x80; });
    const bool printed = whole && first >= 0x20 && first != 0x7f;
    if (printed)
      clean += character;
    else
      clean += '?';
    i += whole ? length : 1;
  }
  return text.size() > kMost ? clean + "..." : clean;
}

}  // namespace sunfleck::detail
