#include "core/detail/toml_file.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <string_view>

#include "core/require.hpp"

namespace sunfleck::detail {
namespace {

// toml++ keeps a table within a table for every dot of a key, without bound; no key of ours has more than one.
void checkDots(std::string_view text, const std::string& source) {
  constexpr int kMostDots = 32;
  int line = 1, dots = 0;
  for (const char c : text) {
    line += c == '\n';
    if (std::string_view(",=[]{}#\n").find(c) != std::string_view::npos) dots = 0;
    if (c == '.' && ++dots > kMostDots)
      throw InvalidInput(
          fmt::format("{}:{}: more than {} dots on end: must be a number or a key", source, line, kMostDots));
  }
}

}  // namespace

void readToml(std::string_view text, const std::string& source, const std::function<void(const toml::table&)>& read) {
  try {
    checkDots(text, source);
    read(toml::parse(text, source));
  } catch (const toml::parse_error& e) {
    throw InvalidInput(fmt::format("{}:{}: {}", source, e.source().begin.line, e.description()));
  } catch (const InvalidInput& e) {
    const std::string message = e.what();
    if (message.starts_with(source)) throw;
    throw InvalidInput(source + ": " + message);
  }
}

void readToml(const std::filesystem::path& file, const std::function<void(const toml::table&)>& read) {
  if (!std::filesystem::is_regular_file(file)) throw InvalidInput(file.string() + ": must be a file that can be read");
  std::ifstream in(file, std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  if (!in) throw InvalidInput(file.string() + ": cannot be read");
  readToml(text, file.string(), read);
}

}  // namespace sunfleck::detail
