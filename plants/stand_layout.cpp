#include "plants/stand_layout.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "core/random.hpp"
#include "core/require.hpp"
#include "plants/detail/portable_math.hpp"

namespace sunfleck {
namespace {

constexpr double kMostTrees = 100'000;

void validate(glm::vec2 size, float distance) {
  constexpr float kLongest = 1e6f;  // [m]
  for (const float length : {size.x, size.y, distance})
    require(length > 0.f && length <= kLongest, "stand: length [m]", length, "above 0 and at most 1e6");
}

void checkCount(double trees) {
  require(trees <= kMostTrees, "stand: number of trees", trees, "at most 100000");
}

glm::dvec2 within(glm::vec2 size, Random& random) {
  const double x = random.uniformDouble() - 0.5, y = random.uniformDouble() - 0.5;
  return {x * double{size.x}, y * double{size.y}};
}

// Places in square cells, one in each at most: the cell's diagonal is the least distance.
class Cells {
 public:
  Cells(glm::vec2 size, double distance)
      : half_(0.5 * glm::dvec2(size)),
        distance_(distance),
        side_(distance / std::numbers::sqrt2),
        columns_(1 + static_cast<long>(double{size.x} / side_)),
        rows_(1 + static_cast<long>(double{size.y} / side_)) {
    // A disc packing is no denser than 0.907: of each place's disc of half the distance.
    checkCount(0.907 * (double{size.x} + distance) * (double{size.y} + distance) /
               (0.25 * std::numbers::pi * distance * distance));
    cells_.assign(static_cast<std::size_t>(columns_ * rows_), -1);
  }

  bool fits(const glm::dvec2& place, const std::vector<glm::dvec2>& places) const {
    if (std::abs(place.x) > half_.x || std::abs(place.y) > half_.y) return false;
    const long column = columnOf(place), row = rowOf(place);
    for (long r = std::max(0L, row - 2); r <= std::min(rows_ - 1, row + 2); ++r)
      for (long c = std::max(0L, column - 2); c <= std::min(columns_ - 1, column + 2); ++c) {
        const int other = cells_[static_cast<std::size_t>(r * columns_ + c)];
        if (other >= 0 && glm::distance(places[static_cast<std::size_t>(other)], place) < distance_) return false;
      }
    return true;
  }

  void put(const glm::dvec2& place, std::size_t number) {
    cells_[static_cast<std::size_t>(rowOf(place) * columns_ + columnOf(place))] = static_cast<int>(number);
  }

 private:
  long columnOf(const glm::dvec2& p) const {
    return std::clamp(static_cast<long>((p.x + half_.x) / side_), 0L, columns_ - 1);
  }
  long rowOf(const glm::dvec2& p) const {
    return std::clamp(static_cast<long>((p.y + half_.y) / side_), 0L, rows_ - 1);
  }

  glm::dvec2 half_;
  double distance_, side_;
  long columns_, rows_;
  std::vector<int> cells_;
};

std::vector<Placement> placed(const std::vector<glm::dvec2>& places) {
  std::vector<Placement> trees;
  for (const glm::dvec2& place : places)
    trees.push_back({.position = {static_cast<float>(place.x), static_cast<float>(place.y), 0.f}});
  return trees;
}

}  // namespace

float crownRadius(const TreeMesh& mesh) {
  float radius = 0.f;
  for (const glm::uvec3& t : mesh.leaf_triangles)
    for (int corner = 0; corner < 3; ++corner)
      radius = std::max(radius, glm::length(glm::vec2(mesh.vertices[t[corner]])));
  return radius;
}

std::vector<Placement> gridStand(glm::vec2 size, float spacing, float jitter, std::uint64_t seed) {
  validate(size, spacing);
  require(jitter >= 0.f && jitter <= 1.f, "stand: jitter", jitter, "in [0, 1]");
  // A rectangle of whole spacings holds them all, whatever its rounding.
  const double columns = std::max(1., std::floor(double{size.x} / double{spacing} + 1e-6));
  const double rows = std::max(1., std::floor(double{size.y} / double{spacing} + 1e-6));
  checkCount(columns * rows);
  Random random(seed, 0);
  std::vector<glm::dvec2> places;
  for (double row = 0.; row < rows; ++row)
    for (double column = 0.; column < columns; ++column) {
      const glm::dvec2 middle(column - 0.5 * (columns - 1.), row - 0.5 * (rows - 1.));
      places.push_back(double{spacing} * (middle + double{jitter} * within({1.f, 1.f}, random)));
    }
  return placed(places);
}

std::vector<Placement> poissonStand(glm::vec2 size, float distance, std::uint64_t seed) {
  validate(size, distance);
  Random random(seed, 0);
  Cells cells(size, double{distance});
  std::vector<glm::dvec2> places;
  std::vector<std::size_t> open;  // about which there may be room
  const auto put = [&](const glm::dvec2& place) {
    cells.put(place, places.size());
    open.push_back(places.size());
    places.push_back(place);
  };
  put(within(size, random));
  while (!open.empty()) {
    const auto chosen = static_cast<std::size_t>(random.uniformDouble() * static_cast<double>(open.size()));
    constexpr int kTries = 30;
    bool room = false;
    for (int i = 0; i < kTries && !room; ++i) {
      const double u = random.uniformDouble(), angle = 2. * std::numbers::pi * random.uniformDouble();
      const double away = double{distance} * std::sqrt(1. + 3. * u);  // evenly over the ring to twice the distance
      const glm::dvec2 place =
          places[open[chosen]] + away * glm::dvec2(detail::portable::cosine(angle), detail::portable::sine(angle));
      room = cells.fits(place, places);
      if (room) put(place);
    }
    if (!room) {
      open[chosen] = open.back();
      open.pop_back();
    }
  }
  return placed(places);
}

}  // namespace sunfleck
