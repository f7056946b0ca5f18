#pragma once

#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace sunfleck::apps {

// A line of a CSV file that is not empty, cut at its commas.
struct CsvRow {
  std::string where;  // "FILE:LINE: ", with which messages begin
  std::vector<std::string> fields;
};

// The lines after the first, which must be `header`. Throws InvalidInput naming file and line when the file cannot be
// read, has another header, a line of another number of fields or more than 10,000 lines.
std::vector<CsvRow> readCsvRows(const std::string& file, std::string_view header);

// Pieces of small text files. They throw InvalidInput, too.
std::ifstream openedText(const std::string& file);
std::vector<std::string_view> fieldsOf(std::string_view line, std::string_view separators);
double numberAt(std::string_view field, const std::string& where);
void removeByteOrderMark(std::string& line);  // as spreadsheets write it before the first line
void removeReturn(std::string& line);

inline constexpr std::size_t kMostTextLines = 10'000;

}  // namespace sunfleck::apps
