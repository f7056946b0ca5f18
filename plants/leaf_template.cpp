#include "plants/detail/leaf_template.hpp"

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include "plants/detail/portable_math.hpp"
#include "plants/detail/stem.hpp"
#include "plants/detail/triangulate.hpp"

namespace sunfleck::detail {
namespace {

// The right half of a leaf, flat.
struct Half {
  std::vector<glm::dvec2> points;
  std::vector<glm::uvec3> triangles;
};

Half halfOf(LeafShape shape) {
  const auto outline = halfOutline(shape);
  Half half{.points = {outline.begin(), outline.end()}, .triangles = {}};
  std::vector<glm::vec3> flat;
  for (const glm::dvec2& p : half.points) flat.emplace_back(p.x, p.y, 0.);
  std::vector<std::uint32_t> corners(flat.size());
  std::iota(corners.begin(), corners.end(), 0u);
  triangulate(flat, corners, half.triangles);
  return half;
}

// Cuts the triangles that the line across at `y` divides.
void cutAcross(Half& half, double y) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> cuts;  // of edges, by their ends
  const auto cutOf = [&](std::uint32_t a, std::uint32_t b) {
    const auto [known, is_new] = cuts.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(half.points.size()));
    if (is_new) {
      const glm::dvec2 from = half.points[std::min(a, b)], to = half.points[std::max(a, b)];
      half.points.emplace_back(from.x + (to.x - from.x) * (y - from.y) / (to.y - from.y), y);
    }
    return known->second;
  };
  std::vector<glm::uvec3> all;
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a != b && b != c && c != a) all.emplace_back(a, b, c);
  };
  for (glm::uvec3 t : half.triangles) {
    const auto side = [&](std::uint32_t i) { return (half.points[i].y > y) - (half.points[i].y < y); };
    // Turned so that the line divides the edge from the first corner to the second.
    for (int turn = 0; turn < 2 && side(t.x) * side(t.y) >= 0; ++turn) t = {t.y, t.z, t.x};
    if (side(t.x) * side(t.y) >= 0) {
      all.push_back(t);
      continue;
    }
    const std::uint32_t first = cutOf(t.x, t.y);
    if (side(t.z) == 0) {
      add(t.x, first, t.z);
      add(first, t.y, t.z);
    } else if (side(t.z) == side(t.x)) {
      const std::uint32_t second = cutOf(t.y, t.z);
      add(first, t.y, second);
      add(t.x, first, second);
      add(t.x, second, t.z);
    } else {
      const std::uint32_t second = cutOf(t.z, t.x);
      add(t.x, first, second);
      add(first, t.y, second);
      add(second, t.y, t.z);
    }
  }
  half.triangles = std::move(all);
}

// A leaf's midrib as straight pieces of the same length, each turned further down.
class Midrib {
 public:
  explicit Midrib(double bend) : bend_(bend), pieces_(1 + static_cast<int>(std::ceil(std::abs(bend) / kMostTurn))) {
    for (int piece = 0; piece < pieces_; ++piece)
      starts_.push_back(starts_.back() + along(piece + 0.5) / double(pieces_));
  }

  int pieces() const { return pieces_; }

  // The point over `y` along the flat midrib, `height` off it; x and y of the result are along and off the leaf.
  glm::dvec2 at(double y, double height) const {
    const double place = y * pieces_, joint = std::nearbyint(place);
    const bool at_joint = std::abs(place - joint) < 1e-9 && joint > 0. && joint < pieces_;
    const int piece = std::clamp(static_cast<int>(at_joint ? joint : std::floor(place)), 0, pieces_ - 1);
    const glm::dvec2 to = along(at_joint ? piece : piece + 0.5);
    return starts_[static_cast<std::size_t>(piece)] + (y - double(piece) / pieces_) * to +
           height * glm::dvec2(-to.y, to.x);
  }

 private:
  static constexpr double kMostTurn = std::numbers::pi / 6.;  // between pieces

  glm::dvec2 along(double piece) const {
    const double angle = bend_ * piece / pieces_;
    return {portable::cosine(angle), -portable::sine(angle)};
  }

  double bend_;
  int pieces_;
  std::vector<glm::dvec2> starts_{glm::dvec2(0.)};
};

// Of a leaf that is still flat. Lobes may reach behind the base.
std::vector<ImageCorners> cornersInImages(const LeafTemplate& flat) {
  double low = 0., high = 1.;
  for (const glm::dvec3& v : flat.vertices) {
    low = std::min(low, v.y);
    high = std::max(high, v.y);
  }
  std::vector<ImageCorners> all;
  for (const glm::uvec3& t : flat.triangles) {
    ImageCorners& corners = all.emplace_back();
    for (int c = 0; c < 3; ++c) {
      const glm::dvec3& v = flat.vertices[t[c]];
      corners[static_cast<std::size_t>(c)] = glm::dvec2(0.5 * (1. - v.x), (v.y - low) / (high - low));
    }
  }
  return all;
}

}  // namespace

LeafTemplate leafTemplate(LeafShape shape, double width, double fold, double curl) {
  LeafTemplate leaf;
  if (shape == LeafShape::rectangle && fold == 0. && curl == 0.) {
    leaf.vertices = {{-1., 0., 0.}, {1., 0., 0.}, {1., 1., 0.}, {-1., 1., 0.}};
    leaf.triangles = {{0, 2, 1}, {0, 3, 2}};
    leaf.corners = cornersInImages(leaf);
    return leaf;
  }
  const Midrib midrib(radians(curl));
  Half half = halfOf(shape);
  for (int joint = 1; joint < midrib.pieces(); ++joint) cutAcross(half, double(joint) / midrib.pieces());
  std::vector<std::uint32_t> mirrored;  // of each point of the right half
  for (const glm::dvec2& p : half.points) leaf.vertices.emplace_back(p.x, p.y, 0.);
  for (std::uint32_t i = 0; i < half.points.size(); ++i) {
    const glm::dvec2 p = half.points[i];
    mirrored.push_back(p.x == 0. ? i : static_cast<std::uint32_t>(leaf.vertices.size()));
    if (p.x != 0.) leaf.vertices.emplace_back(-p.x, p.y, 0.);
  }
  for (const glm::uvec3& t : half.triangles) leaf.triangles.push_back({t.x, t.z, t.y});
  for (const glm::uvec3& t : half.triangles) leaf.triangles.push_back({mirrored[t.x], mirrored[t.y], mirrored[t.z]});
  leaf.corners = cornersInImages(leaf);
  const double lift = radians(0.5 * fold);
  for (glm::dvec3& v : leaf.vertices) {
    const double height = std::abs(v.x) * 0.5 * width * portable::sine(lift);
    const glm::dvec2 bent = midrib.at(v.y, height);
    v = {v.x * portable::cosine(lift), bent.x, bent.y};
  }
  return leaf;
}

}  // namespace sunfleck::detail
