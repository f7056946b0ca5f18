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
  std::string clean(text.substr(0, kMost));
  std::replace_if(
      clean.begin(), clean.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
  return text.size() > kMost ? clean + "..." : clean;
}

}  // namespace sunfleck::detail
