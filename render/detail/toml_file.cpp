#include "render/detail/toml_file.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <string_view>

#include "core/require.hpp"

namespace sunfleck::detail {
namespace {

// toml++ keeps a table within a table for every dot of a key, without bound; no key of ours has more than one.
std::string textOf(const std::filesystem::path& file) {
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

}  // namespace

void readToml(const std::filesystem::path& file, const std::function<void(const toml::table&)>& read) {
  try {
    read(toml::parse(textOf(file), file.string()));
  } catch (const toml::parse_error& e) {
    throw InvalidInput(fmt::format("{}:{}: {}", file.string(), e.source().begin.line, e.description()));
  } catch (const InvalidInput& e) {
    const std::string message = e.what();
    if (message.starts_with(file.string())) throw;
    throw InvalidInput(file.string() + ": " + message);
  }
}

}  // namespace sunfleck::detail
