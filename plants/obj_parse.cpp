#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <unordered_set>

#include "core/require.hpp"
#include "plants/detail/input_file.hpp"
#include "plants/detail/obj.hpp"
#include "plants/detail/triangulate.hpp"

namespace sunfleck::detail {
namespace {

constexpr std::string_view kBlank = " \t";
constexpr std::size_t kMostCorners = 1000;  // cutting a polygon's ears takes the square of it
constexpr long long kMostIndex = std::numeric_limits<std::int32_t>::max();

bool isBlank(char c) {
  return c == ' ' || c == '\t';
}

// Takes the next word off the line; empty at its end.
std::string_view nextWord(std::string_view& line) {
  std::size_t start = 0;
  while (start < line.size() && isBlank(line[start])) ++start;
  std::size_t end = start;
  while (end < line.size() && !isBlank(line[end])) ++end;
  const std::string_view word = line.substr(start, end - start);
  line.remove_prefix(end);
  return word;
}

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlank), text.size()));
  text.remove_suffix(text.size() - std::min(text.find_last_not_of(kBlank) + 1, text.size()));
  return text;
}

std::string_view withoutPlus(std::string_view word) {
  return word.starts_with('+') && !word.starts_with("+-") ? word.substr(1) : word;
}

// One pass over the text that checks what it reads. tinyobjloader takes "nan" and missing numbers for 0, leaves indices
// unchecked, drops the names of materials that no .mtl defines, and takes as long.
class ObjParser {
 public:
  ObjParser(std::string_view text, const std::string& source)
      : text_(text), source_(source), known_parts_(0, PartHash{&file_.faces.parts}, PartSame{&file_.faces.parts}) {}

  ObjFile parse() {
    refuseZeroByte();
    for (std::string_view left = text_; !left.empty();) readLine(wholeLine(left));
    if (faces_ == 0) throw InvalidInput(source_ + ": has no faces, so no leaves");
    if (highest_index_ > vertexCount()) {
      line_ = highest_line_;
      refuse("vertex index", std::to_string(highest_index_),
             "at most the number of vertices, " + std::to_string(vertexCount()));
    }
    for (const Deferred& face : deferred_) cut(face.corners, face.textures, face.part);
    if (file_.faces.texture.empty()) file_.faces.texture_corners = {};
    return std::move(file_);
  }

 private:
  struct PartHash {
    const std::vector<Part>* parts;
    std::size_t operator()(std::uint32_t part) const {
      const std::hash<std::string_view> hash;
      const Part& p = (*parts)[part];
      return hash(p.material) ^ 31 * hash(p.groups) ^ 961 * hash(p.object);
    }
  };
  struct PartSame {
    const std::vector<Part>* parts;
    bool operator()(std::uint32_t a, std::uint32_t b) const {
      const Part &p = (*parts)[a], &q = (*parts)[b];
      return p.material == q.material && p.groups == q.groups && p.object == q.object;
    }
  };
  // A face whose vertices come later.
  struct Deferred {
    std::vector<std::uint32_t> corners, textures;
    std::uint32_t part;
  };

  long long vertexCount() const { return static_cast<long long>(file_.faces.vertices.size()); }

  [[noreturn]] void refuse(const std::string& what, std::string_view value, const std::string& rule) const {
    const std::string where = source_ + " line " + std::to_string(line_);
    require(false, where + ": " + what, shown(value), rule);
    throw InvalidInput(where);
  }

  void refuseZeroByte() {
    const std::size_t zero = text_.find('\0');
    if (zero == std::string_view::npos) return;
    for (std::string_view left = text_.substr(0, zero); !left.empty();) nextLine(left);
    const bool at_start = zero == 0 || text_[zero - 1] == '\n' || text_[zero - 1] == '\r';
    throw InvalidInput(source_ + " line " + std::to_string(line_ + (at_start ? 1 : 0)) +
                       ": holds a zero byte: must be text");
  }

  // Takes the next line off; it ends with a line feed, a carriage return or both.
  std::string_view nextLine(std::string_view& left) {
    ++line_;
    const std::size_t end = std::min(left.find_first_of("\r\n"), left.size());
    const std::string_view line = left.substr(0, end);
    const bool both = left.substr(end).starts_with("\r\n");
    left.remove_prefix(std::min(left.size(), end + (both ? 2 : 1)));
    return line;
  }

  // A backslash at its end continues a line in the next one.
  std::string_view wholeLine(std::string_view& left) {
    const std::string_view line = nextLine(left);
    if (!line.ends_with('\\') || line.starts_with('#')) return line;
    std::string& joined = file_.joined.emplace_back(line);
    while (joined.ends_with('\\') && !left.empty()) {
      joined.back() = ' ';
      joined += nextLine(left);
    }
    if (joined.ends_with('\\')) joined.pop_back();
    return joined;
  }

  void readLine(std::string_view line) {
    const std::string_view keyword = nextWord(line);
    if (keyword == "v")
      readVertex(line);
    else if (keyword == "f")
      readFace(line);
    else if (keyword == "vt")
      readTexture(line);
    else if (keyword == "usemtl")
      name(current_.material, line);
    else if (keyword == "g")
      name(current_.groups, line);
    else if (keyword == "o")
      name(current_.object, line);
    else if (keyword == "mtllib")
      file_.material_files.push_back(trimmed(line));
  }

  void name(std::string_view& of_current, std::string_view line) {
    of_current = trimmed(line);
    current_part_ = kNone;
  }

  float coordinate(std::string_view& line, const char* what) {
    const std::string_view word = withoutPlus(nextWord(line));
    double value = 0.;
    const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || failure != std::errc() || end != word.data() + word.size() ||
        !(std::abs(value) <= double{std::numeric_limits<float>::max()}))
      refuse(what, word.empty() ? "(missing)" : word, "a finite number");
    return static_cast<float>(value);
  }

  void readVertex(std::string_view line) {
    const float x = coordinate(line, "vertex x"), y = coordinate(line, "vertex y"), z = coordinate(line, "vertex z");
    file_.faces.vertices.emplace_back(x, y, z);
  }

  // One that cannot be read is refused only where a mask needs it.
  void readTexture(std::string_view line) {
    glm::vec2 at(std::numeric_limits<float>::quiet_NaN());
    for (int axis = 0; axis < 2; ++axis) {
      const std::string_view word = withoutPlus(nextWord(line));
      std::from_chars(word.data(), word.data() + word.size(), at[axis]);
    }
    file_.faces.texture.push_back(at);
  }

  // Counts from 1, or back from the last where it is negative; from 0 then.
  long long indexOf(std::string_view digits, std::string_view word) {
    long long index = 0;
    const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
    const bool whole = !digits.empty() && end == digits.data() + digits.size();
    if (!whole || failure == std::errc::invalid_argument) refuse("vertex index", word, "a whole number");
    if (failure != std::errc() || index > kMostIndex) refuse("vertex index", word, "at most the number of vertices");
    return index;
  }

  void addCorner(std::string_view word) {
    const std::size_t slash = word.find('/');
    const long long index = indexOf(withoutPlus(word.substr(0, slash)), word);
    std::uint32_t texture = NamedTriangles::kNoTexture;
    if (slash != std::string_view::npos) {
      const std::string_view rest = word.substr(slash + 1), of_texture = rest.substr(0, rest.find('/'));
      if (std::count(rest.begin(), rest.end(), '/') > 1)
        refuse("corner", word, "of the form v, v/vt, v//vn or v/vt/vn");
      texture = textureOf(of_texture);
    }
    if (index == 0) refuse("vertex index", word, "1 or more, or negative to count back");
    if (index < -vertexCount())
      refuse("vertex index", word, "no further back than the " + std::to_string(vertexCount()) + " vertices before it");
    if (index > highest_index_) {
      highest_index_ = index;
      highest_line_ = line_;
    }
    corners_.push_back(static_cast<std::uint32_t>(index > 0 ? index - 1 : vertexCount() + index));
    textures_.push_back(texture);
  }

  // One that is out of range or none counts as not given: it matters to masks alone, which then refuse it.
  std::uint32_t textureOf(std::string_view digits) const {
    long long index = 0;
    const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
    const auto count = static_cast<long long>(file_.faces.texture.size());
    if (failure != std::errc() || end != digits.data() + digits.size()) return NamedTriangles::kNoTexture;
    const long long from0 = index > 0 ? index - 1 : count + index;
    return index != 0 && from0 >= 0 && from0 <= kMostIndex ? static_cast<std::uint32_t>(from0)
                                                           : NamedTriangles::kNoTexture;
  }

  void readFace(std::string_view line) {
    corners_.clear();
    textures_.clear();
    std::size_t count = 0;
    for (std::string_view word = nextWord(line); !word.empty(); word = nextWord(line)) {
      if (++count <= kMostCorners) addCorner(word);
    }
    if (count < 3 || count > kMostCorners)
      refuse("number of corners of the face", std::to_string(count), "from 3 to 1000");
    ++faces_;
    const std::uint32_t part = currentPart();
    const bool later = std::any_of(corners_.begin(), corners_.end(),
                                   [&](std::uint32_t corner) { return corner >= file_.faces.vertices.size(); });
    if (count > 3 && later)
      deferred_.push_back({corners_, textures_, part});
    else
      cut(corners_, textures_, part);
  }

  void cut(const std::vector<std::uint32_t>& corners, const std::vector<std::uint32_t>& textures, std::uint32_t part) {
    NamedTriangles& faces = file_.faces;
    const std::size_t before = faces.triangles.size();
    triangulate(faces.vertices, corners, faces.triangles);
    faces.part_of_triangle.resize(faces.triangles.size(), part);
    for (std::size_t i = before; i < faces.triangles.size(); ++i) {
      glm::uvec3& of_corners = faces.texture_corners.emplace_back();
      for (int c = 0; c < 3; ++c) {
        const auto at = std::find(corners.begin(), corners.end(), faces.triangles[i][c]) - corners.begin();
        of_corners[c] = textures[static_cast<std::size_t>(at)];
      }
    }
  }

  std::uint32_t currentPart() {
    if (current_part_ == kNone) {
      file_.faces.parts.push_back(current_);
      const auto [known, is_new] = known_parts_.insert(static_cast<std::uint32_t>(file_.faces.parts.size() - 1));
      if (!is_new) file_.faces.parts.pop_back();
      current_part_ = *known;
    }
    return current_part_;
  }

  static constexpr std::uint32_t kNone = ~0u;

  std::string_view text_;
  const std::string& source_;
  ObjFile file_;
  Part current_{};
  std::uint32_t current_part_ = kNone;
  std::unordered_set<std::uint32_t, PartHash, PartSame> known_parts_;
  std::vector<std::uint32_t> corners_, textures_;  // of the face being read
  std::vector<Deferred> deferred_;
  std::size_t line_ = 0, faces_ = 0, highest_line_ = 0;
  long long highest_index_ = 0;
};

}  // namespace

ObjFile parseObj(std::string_view text, const std::string& source) {
  return ObjParser(text, source).parse();
}

}  // namespace sunfleck::detail
