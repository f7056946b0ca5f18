#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "core/require.hpp"
#include "plants/detail/input_file.hpp"
#include "plants/detail/ply.hpp"

namespace sunfleck::detail {
namespace {

using Type = PlyHeader::Type;

constexpr std::array<std::pair<std::string_view, Type>, 16> kTypeNames{{{"char", Type::int8},
                                                                        {"int8", Type::int8},
                                                                        {"uchar", Type::uint8},
                                                                        {"uint8", Type::uint8},
                                                                        {"short", Type::int16},
                                                                        {"int16", Type::int16},
                                                                        {"ushort", Type::uint16},
                                                                        {"uint16", Type::uint16},
                                                                        {"int", Type::int32},
                                                                        {"int32", Type::int32},
                                                                        {"uint", Type::uint32},
                                                                        {"uint32", Type::uint32},
                                                                        {"float", Type::float32},
                                                                        {"float32", Type::float32},
                                                                        {"double", Type::float64},
                                                                        {"float64", Type::float64}}};

class HeaderReader {
 public:
  HeaderReader(std::string_view text, const std::string& source) : text_(text), source_(source) {}

  PlyHeader read() {
    if (nextLine() != std::vector<std::string_view>{"ply"}) refuse("first line", "\"ply\"");
    bool has_format = false;
    for (;;) {
      const std::vector<std::string_view> words = nextLine();
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") break;
      if (words[0] == "format") {
        readFormat(words);
        has_format = true;
      } else if (words[0] == "element") {
        readElement(words);
      } else if (words[0] == "property") {
        readProperty(words);
      } else {
        refuse("keyword", "format, element, property, comment or end_header");
      }
    }
    if (!has_format) refuse("end_header", "after a format line");
    header_.body = at_;
    header_.line = line_ + 1;
    return std::move(header_);
  }

 private:
  [[noreturn]] void refuse(const std::string& what, const std::string& rule) const {
    const std::string where = source_ + " line " + std::to_string(line_);
    require(false, where + ": " + what, shown(current_), rule);
    throw InvalidInput(where);
  }

  std::vector<std::string_view> nextLine() {
    constexpr std::size_t kLongest = 10'000;  // [byte]; no header line is, so this is no PLY
    const std::size_t end = text_.substr(0, at_ + kLongest).find('\n', at_);
    ++line_;
    if (end == std::string_view::npos)
      throw InvalidInput(source_ + " line " + std::to_string(line_) + ": the PLY header ends without end_header");
    current_ = text_.substr(at_, end - at_);
    at_ = end + 1;
    std::vector<std::string_view> words;
    for (std::string_view rest = current_; !rest.empty();) {
      rest.remove_prefix(std::min(rest.find_first_not_of(" \t\r"), rest.size()));
      const std::size_t length = std::min(rest.find_first_of(" \t\r"), rest.size());
      if (length > 0) words.push_back(rest.substr(0, length));
      rest.remove_prefix(length);
    }
    return words;
  }

  void readFormat(const std::vector<std::string_view>& words) {
    constexpr std::array<std::pair<std::string_view, PlyHeader::Format>, 3> kFormats{
        {{"ascii", PlyHeader::Format::ascii},
         {"binary_little_endian", PlyHeader::Format::little_endian},
         {"binary_big_endian", PlyHeader::Format::big_endian}}};
    const auto found = std::find_if(kFormats.begin(), kFormats.end(),
                                    [&](const auto& format) { return words.size() == 3 && words[1] == format.first; });
    if (found == kFormats.end() || words[2] != "1.0")
      refuse("format", "ascii, binary_little_endian or binary_big_endian, with version 1.0");
    header_.format = found->second;
  }

  void readElement(const std::vector<std::string_view>& words) {
    std::size_t count = 0;
    if (words.size() != 3) refuse("element", "a name and a count");
    const auto [end, failure] = std::from_chars(words[2].data(), words[2].data() + words[2].size(), count);
    if (failure != std::errc() || end != words[2].data() + words[2].size()) refuse("element", "a name and a count");
    header_.elements.push_back({.name = std::string(words[1]), .count = count, .properties = {}});
  }

  Type typeOf(std::string_view name) const {
    const auto found =
        std::find_if(kTypeNames.begin(), kTypeNames.end(), [&](const auto& type) { return type.first == name; });
    if (found == kTypeNames.end()) refuse("property", "of a PLY type, such as float or int");
    return found->second;
  }

  void readProperty(const std::vector<std::string_view>& words) {
    if (header_.elements.empty()) refuse("property", "after an element");
    auto& properties = header_.elements.back().properties;
    if (words.size() == 5 && words[1] == "list") {
      const Type count_type = typeOf(words[2]);
      if (count_type == Type::float32 || count_type == Type::float64) refuse("list count", "of a whole-number type");
      properties.push_back({.name = std::string(words[4]), .type = typeOf(words[3]), .count_type = count_type});
    } else if (words.size() == 3) {
      properties.push_back({.name = std::string(words[2]), .type = typeOf(words[1]), .count_type = {}});
    } else {
      refuse("property", "a type and a name, or list, two types and a name");
    }
  }

  std::string_view text_;
  const std::string& source_;
  std::string_view current_;
  std::size_t at_ = 0, line_ = 0;
  PlyHeader header_;
};

}  // namespace

std::size_t sizeOf(PlyHeader::Type type) {
  constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

PlyHeader readPlyHeader(std::string_view text, const std::string& source) {
  return HeaderReader(text, source).read();
}

}  // namespace sunfleck::detail
