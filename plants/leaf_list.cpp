#include "plants/detail/leaf_list.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "core/directions.hpp"
#include "core/require.hpp"
#include "plants/detail/input_file.hpp"

namespace sunfleck::detail {
namespace {

constexpr int kCorners = 12;
constexpr std::array<const char*, 7> kColumns{"radius", "x", "y", "z", "nx", "ny", "nz"};

class LeafListReader {
 public:
  explicit LeafListReader(const std::string& source) : source_(source) {
    // A regular polygon of n corners at distance r has the area n/2 sin(2 pi / n) r^2: that of the disc.
    constexpr double kTurn = 2. * std::numbers::pi / kCorners;
    const double widening = std::sqrt(std::numbers::pi / (0.5 * kCorners * std::sin(kTurn)));
    for (std::size_t i = 0; i < kCorners; ++i)
      corners_[i] = {widening * std::cos(kTurn * static_cast<double>(i)),
                     widening * std::sin(kTurn * static_cast<double>(i))};
    // The image's edges touch the polygon.
    const auto inImage = [&](std::size_t i) { return glm::vec2(0.5 + 0.5 / widening * corners_[i]); };
    for (std::size_t i = 1; i + 1 < kCorners; ++i)
      mesh_.patches.push_back({.corners = {inImage(0), inImage(i), inImage(i + 1)}});
  }

  TreeMesh read(std::string_view text) {
    while (!text.empty()) {
      ++line_;
      const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
      std::string_view line = text.substr(0, end);
      const bool both = text.substr(end).starts_with("\r\n");
      text.remove_prefix(std::min(text.size(), end + (both ? 2 : 1)));
      readLine(line.substr(0, line.find('#')));
    }
    if (mesh_.leaf_triangles.empty()) throw InvalidInput(source_ + ": has no leaves");
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void refuse(const std::string& what, std::string_view value, const std::string& rule) const {
    const std::string where = source_ + " line " + std::to_string(line_);
    require(false, where + ": " + what, shown(value), rule);
    throw InvalidInput(where);
  }

  void readLine(std::string_view line) {
    std::array<double, kColumns.size()> numbers{};
    std::size_t count = 0;
    for (;; ++count) {
      line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
      const std::string_view word = line.substr(0, line.find_first_of(" \t"));
      line.remove_prefix(word.size());
      if (word.empty()) break;
      if (count == kColumns.size()) refuse("eighth number", word, "absent: a leaf is radius x y z nx ny nz");
      const std::string_view digits = word.starts_with('+') && !word.starts_with("+-") ? word.substr(1) : word;
      const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), numbers[count]);
      if (failure != std::errc() || end != digits.data() + digits.size() ||
          !(std::abs(numbers[count]) <= double{std::numeric_limits<float>::max()}))
        refuse(kColumns[count], word, "a finite number");
    }
    if (count == 0) return;
    if (count < kColumns.size()) refuse(kColumns[count], "(missing)", "a finite number");
    if (!(numbers[0] > 0.)) require(false, where() + "radius", numbers[0], "above 0");
    addLeaf(numbers[0], {numbers[1], numbers[2], numbers[3]}, {numbers[4], numbers[5], numbers[6]});
  }

  std::string where() const { return source_ + " line " + std::to_string(line_) + ": "; }

  void addLeaf(double radius, const glm::dvec3& centre, const glm::dvec3& normal) {
    const double length = glm::length(normal);
    if (!(length > 0.)) require(false, where() + "length of the normal", length, "above 0");
    const Axes axes = axesAlong(Direction(normal / length));
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (const glm::dvec2& corner : corners_)
      mesh_.vertices.emplace_back(centre +
                                  radius * (corner.x * glm::dvec3(axes.right) + corner.y * glm::dvec3(axes.up)));
    for (std::uint32_t i = 1; i + 1 < kCorners; ++i) {
      mesh_.leaf_triangles.push_back({first, first + i, first + i + 1});
      mesh_.patch_of_triangle.push_back(i - 1);
    }
  }

  const std::string& source_;
  std::array<glm::dvec2, kCorners> corners_;
  std::size_t line_ = 0;
  TreeMesh mesh_;
};

}  // namespace

TreeMesh readLeafList(std::string_view text, const std::string& source) {
  return LeafListReader(source).read(text);
}

}  // namespace sunfleck::detail
