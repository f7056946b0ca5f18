#include "leaves/detail/number_table.hpp"

#include <algorithm>
#include <charconv>

#include "leaves/detail/data_texts.hpp"

namespace sunfleck::detail {

std::vector<double> numberTable(std::string_view text) {
  std::vector<double> numbers;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const char* at = text.data();
    const char* const line_end = at + end;
    while (*text.data() != '#' && at != line_end) {
      double value = 0.;
      at = std::from_chars(at, line_end, value).ptr;
      numbers.push_back(value);
      at = std::find_if(at, line_end, [](char c) { return c != ' '; });
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return numbers;
}

std::string_view dataText(std::string_view name) {
  return std::ranges::find_if(dataTexts(), [&](const DataText& data) { return data.path.ends_with(name); })->text;
}

}  // namespace sunfleck::detail
