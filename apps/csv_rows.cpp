#include "apps/csv_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "apps/number_text.hpp"
#include "core/require.hpp"

namespace sunfleck::apps {

std::ifstream openedText(const std::string& file) {
  std::error_code failure;
  std::ifstream in(file);
  if (!in || std::filesystem::is_directory(file, failure)) throw InvalidInput(file + ": cannot be read");
  return in;
}

std::vector<std::string_view> fieldsOf(std::string_view line, std::string_view separators) {
  std::vector<std::string_view> fields;
  for (;;) {
    const std::size_t end = line.find_first_of(separators);
    fields.push_back(line.substr(0, end));
    if (end == std::string_view::npos) return fields;
    line.remove_prefix(end + 1);
  }
}

double numberAt(std::string_view field, const std::string& where) {
  const std::optional<double> value = numberOf(field);
  if (!value) throw InvalidInput(fmt::format("{}\"{}\": must be a number", where, field.substr(0, 40)));
  return *value;
}

void removeByteOrderMark(std::string& line) {
  if (line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
}

void removeReturn(std::string& line) {
  if (!line.empty() && line.back() == '\r') line.pop_back();
}

std::vector<CsvRow> readCsvRows(const std::string& file, std::string_view header) {
  std::ifstream in = openedText(file);
  const auto columns = static_cast<std::size_t>(std::count(header.begin(), header.end(), ',')) + 1;
  std::vector<CsvRow> rows;
  std::string line;
  std::getline(in, line);
  removeByteOrderMark(line);
  removeReturn(line);
  if (line != header) throw InvalidInput(fmt::format("{}:1: \"{}\": must be {}", file, line.substr(0, 80), header));
  for (std::size_t number = 2; std::getline(in, line); ++number) {
    removeReturn(line);
    if (line.empty()) continue;
    const std::string where = fmt::format("{}:{}: ", file, number);
    if (number > kMostTextLines) throw InvalidInput(fmt::format("{}must have at most {} lines", where, kMostTextLines));
    const auto fields = fieldsOf(line, ",");
    if (fields.size() != columns)
      throw InvalidInput(fmt::format("{}{} fields: must be {}, {}", where, fields.size(), columns, header));
    rows.push_back({where, {fields.begin(), fields.end()}});
  }
  return rows;
}

}  // namespace sunfleck::apps
