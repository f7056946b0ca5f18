#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include "core/require.hpp"
#include "plants/detail/input_file.hpp"
#include "plants/detail/obj.hpp"

namespace sunfleck::detail {
namespace {

constexpr std::string_view kBlank = " \t";
constexpr std::size_t kMostCorners = 1000;  // cutting a polygon's ears takes the square of it

// Takes the next word off the line; empty at its end.
std::string_view nextWord(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(kBlank), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kBlank));
  line.remove_prefix(word.size());
  return word;
}

std::string_view withoutPlus(std::string_view word) {
  return word.starts_with('+') && !word.starts_with("+-") ? word.substr(1) : word;
}

class ObjChecker {
 public:
  explicit ObjChecker(const std::string& source) : source_(source) {}

  void check(std::string_view text) {
    while (!text.empty()) {
      ++line_;
      const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
      checkLine(text.substr(0, end));
      const bool both = text.substr(end).starts_with("\r\n");
      text.remove_prefix(std::min(text.size(), end + (both ? 2 : 1)));
    }
    if (faces_ == 0) throw InvalidInput(source_ + ": has no faces, so no leaves");
    if (highest_index_ > vertices_) {
      line_ = highest_line_;
      refuse("vertex index", std::to_string(highest_index_),
             "at most the number of vertices, " + std::to_string(vertices_));
    }
  }

 private:
  [[noreturn]] void refuse(const std::string& what, std::string_view value, const std::string& rule) const {
    const std::string where = source_ + " line " + std::to_string(line_);
    require(false, where + ": " + what, shown(value), rule);
    throw InvalidInput(where);
  }

  void checkLine(std::string_view line) {
    if (line.find('\0') != std::string_view::npos)
      throw InvalidInput(source_ + " line " + std::to_string(line_) + ": holds a zero byte: must be text");
    const std::string_view keyword = nextWord(line);
    if (keyword == "v") checkVertex(line);
    if (keyword == "f") checkFace(line);
  }

  void checkVertex(std::string_view line) {
    for (const char axis : {'x', 'y', 'z'}) {
      const std::string_view word = withoutPlus(nextWord(line));
      double value = 0.;
      const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (word.empty() || failure != std::errc() || end != word.data() + word.size() ||
          !(std::abs(value) <= double{std::numeric_limits<float>::max()}))
        refuse(std::string("vertex ") + axis, word.empty() ? "(missing)" : word, "a finite number");
    }
    ++vertices_;
  }

  void checkFace(std::string_view line) {
    std::size_t corners = 0;
    for (std::string_view word = nextWord(line); !word.empty(); word = nextWord(line)) {
      ++corners;
      const std::string_view digits = withoutPlus(word.substr(0, word.find('/')));
      long long index = 0;
      const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
      const bool whole = !digits.empty() && end == digits.data() + digits.size();
      if (!whole || failure == std::errc::invalid_argument) refuse("vertex index", word, "a whole number");
      // tinyobjloader would take what follows a third slash for another corner.
      if (std::count(word.begin(), word.end(), '/') > 2)
        refuse("corner", word, "of the form v, v/vt, v//vn or v/vt/vn");
      if (failure != std::errc() || index > std::numeric_limits<int>::max())
        refuse("vertex index", word, "at most the number of vertices");
      if (index == 0) refuse("vertex index", word, "1 or more, or negative to count back");
      if (index < -vertices_)
        refuse("vertex index", word, "no further back than the " + std::to_string(vertices_) + " vertices before it");
      if (index > highest_index_) {
        highest_index_ = index;
        highest_line_ = line_;
      }
    }
    if (corners < 3 || corners > kMostCorners)
      refuse("number of corners of the face", std::to_string(corners), "from 3 to 1000");
    ++faces_;
  }

  const std::string& source_;
  std::size_t line_ = 0;
  long long vertices_ = 0;
  std::size_t faces_ = 0;
  long long highest_index_ = 0;
  std::size_t highest_line_ = 0;
};

}  // namespace

void checkObj(const std::string& text, const std::string& source) {
  ObjChecker(source).check(text);
}

}  // namespace sunfleck::detail
