#include "plants/detail/mask_triangles.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include "core/require.hpp"
#include "plants/detail/mask_outline.hpp"

namespace sunfleck::detail {
namespace {

constexpr std::size_t kMostCorners = 3000;          // of a mask; cutting ears takes the square of it
constexpr std::size_t kMostPixelCorners = 500'000;  // of its outlines before they are simplified: a second's work
constexpr double kMostDropped = 0.009;              // area of specks less that of holes, over that of leaf

bool within(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& p) {
  return turnOf(a, b, p) >= 0. && turnOf(b, c, p) >= 0. && turnOf(c, a, p) >= 0.;
}

// An outline with its holes as one line: a bridge leads to each hole and back (Eberly, "Triangulation by Ear
// Clipping").
class Bridges {
 public:
  Bridges(std::vector<glm::dvec2>& points, const Outline& outline) : points_(points) { line_ = added(outline); }

  bool lead(const Outline& hole) {
    const auto rightmost = static_cast<std::size_t>(
        std::max_element(hole.begin(), hole.end(), [](const auto& a, const auto& b) { return a.x < b.x; }) -
        hole.begin());
    const std::optional<std::size_t> bridge = bridgeTo(hole[rightmost]);
    if (!bridge) return false;
    std::vector<std::uint32_t> way = added(hole);
    std::rotate(way.begin(), way.begin() + static_cast<std::ptrdiff_t>(rightmost), way.end());
    way.push_back(way.front());
    way.push_back(line_[*bridge]);
    line_.insert(line_.begin() + static_cast<std::ptrdiff_t>(*bridge) + 1, way.begin(), way.end());
    return true;
  }

  std::vector<std::uint32_t> line() && { return std::move(line_); }

 private:
  std::vector<std::uint32_t> added(const Outline& outline) {
    std::vector<std::uint32_t> numbers;
    for (const glm::dvec2& point : outline) {
      numbers.push_back(static_cast<std::uint32_t>(points_.size()));
      points_.push_back(point);
    }
    return numbers;
  }

  const glm::dvec2& at(std::size_t i) const { return points_[line_[i % line_.size()]]; }

  // The place in the line that can be seen from a point to its right.
  std::optional<std::size_t> bridgeTo(const glm::dvec2& from) const {
    double nearest = std::numeric_limits<double>::infinity();
    std::optional<std::size_t> end;
    for (std::size_t i = 0; i < line_.size(); ++i) {
      const glm::dvec2 &a = at(i), &b = at(i + 1);
      if ((a.y > from.y) == (b.y > from.y)) continue;
      const double x = a.x + (from.y - a.y) / (b.y - a.y) * (b.x - a.x);
      if (x < from.x || x >= nearest) continue;
      nearest = x;
      end = a.x > b.x ? i : (i + 1) % line_.size();
    }
    if (!end) return end;
    // A corner between hides that one; of such the one at the least angle is seen.
    const glm::dvec2 hit(nearest, from.y), tip = at(*end);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < line_.size(); ++i) {
      const glm::dvec2& p = at(i);
      if (p == tip || p.x < from.x) continue;
      const bool hides = tip.y > from.y ? within(from, hit, tip, p) : within(from, tip, hit, p);
      if (!hides || turnOf(at(i + line_.size() - 1), p, at(i + 1)) > 0.) continue;
      const double angle = std::abs(std::atan2(p.y - from.y, p.x - from.x));
      if (angle < least) {
        least = angle;
        end = i;
      }
    }
    // Where the line comes by twice, by a bridge, the one that has the point on its side.
    for (std::size_t i = 0; i < line_.size(); ++i)
      if (at(i) == at(*end) && faces(i, from)) return i;
    return end;
  }

  bool faces(std::size_t i, const glm::dvec2& p) const {
    const glm::dvec2 &a = at(i + line_.size() - 1), &b = at(i), &c = at(i + 1);
    const bool left_of_first = turnOf(a, b, p) >= 0., left_of_second = turnOf(b, c, p) >= 0.;
    return turnOf(a, b, c) > 0. ? left_of_first && left_of_second : left_of_first || left_of_second;
  }

  std::vector<glm::dvec2>& points_;
  std::vector<std::uint32_t> line_;
};

// Cuts ears off a line that may touch itself.
void cutEars(const std::vector<glm::dvec2>& points, std::vector<std::uint32_t> left,
             std::vector<glm::uvec3>& triangles) {
  std::size_t at = 0, in_vain = 0;
  while (left.size() >= 3 && in_vain <= left.size()) {
    const std::size_t count = left.size(), before = (at + count - 1) % count, after = (at + 1) % count;
    const glm::dvec2 &a = points[left[before]], &b = points[left[at]], &c = points[left[after]];
    const double turn = turnOf(a, b, c);
    bool is_ear = turn > 0.;
    for (std::size_t i = 0; is_ear && i < count; ++i) {
      const glm::dvec2& p = points[left[i]];
      if (i != before && i != at && i != after && p != a && p != b && p != c) is_ear = !within(a, b, c, p);
    }
    if (is_ear || (turn == 0. && (a == b || b == c || a == c || in_vain > 0))) {
      if (is_ear) triangles.push_back({left[before], left[at], left[after]});
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(at));
      in_vain = 0;
      // Onward, so that triangles do not all meet in one corner.
      at = left.empty() ? 0 : at % left.size();
    } else {
      at = (at + 1) % count;
      ++in_vain;
    }
  }
}

// Leaves out what is smaller than `most` [pixel^2], the smallest first, as long as the whole area hardly changes.
void dropSpecks(std::vector<Outline>& outlines, double most) {
  double whole = 0., dropped = 0.;
  for (const Outline& outline : outlines) whole += signedArea(outline);
  std::ranges::stable_sort(
      outlines, [](const Outline& a, const Outline& b) { return std::abs(signedArea(a)) < std::abs(signedArea(b)); });
  std::erase_if(outlines, [&](const Outline& outline) {
    const double area = signedArea(outline);
    if (std::abs(area) >= most || std::abs(dropped + area) > kMostDropped * whole) return false;
    dropped += area;
    return true;
  });
}

// In pixels, y down; nothing if the outlines, simplified so much, cross one another.
std::optional<MaskTriangles> triangulated(std::vector<Outline> outlines, double most) {
  std::vector<Outline> rings, holes;
  double wanted = 0.;
  std::size_t corners = 0;
  dropSpecks(outlines, most);
  simplify(outlines, most);
  for (Outline& outline : outlines) {
    const double area = signedArea(outline);
    wanted += area;
    corners += outline.size();
    (area > 0. ? rings : holes).push_back(std::move(outline));
  }
  if (rings.empty() || corners > kMostCorners) return std::nullopt;
  // The hole that reaches furthest to the right first: its bridge then crosses no other hole.
  const auto right = [](const Outline& o) {
    return std::max_element(o.begin(), o.end(), [](const auto& a, const auto& b) { return a.x < b.x; })->x;
  };
  std::ranges::stable_sort(holes, [&](const Outline& a, const Outline& b) { return right(a) > right(b); });
  std::ranges::stable_sort(rings, [](const Outline& a, const Outline& b) { return signedArea(a) < signedArea(b); });
  std::vector<std::vector<const Outline*>> holes_of(rings.size());
  for (const Outline& hole : holes) {
    const auto ring = std::ranges::find_if(rings, [&](const Outline& r) { return contains(r, hole[0]); });
    if (ring == rings.end()) return std::nullopt;
    holes_of[static_cast<std::size_t>(ring - rings.begin())].push_back(&hole);
  }
  MaskTriangles cut;
  for (std::size_t ring = 0; ring < rings.size(); ++ring) {
    Bridges bridges(cut.corners, rings[ring]);
    for (const Outline* hole : holes_of[ring])
      if (!bridges.lead(*hole)) return std::nullopt;
    cutEars(cut.corners, std::move(bridges).line(), cut.triangles);
  }
  double area = 0.;
  for (const glm::uvec3& t : cut.triangles) area += 0.5 * turnOf(cut.corners[t.x], cut.corners[t.y], cut.corners[t.z]);
  if (std::abs(area - wanted) > 1e-3 * wanted) return std::nullopt;
  return cut;
}

}  // namespace

MaskTriangles trianglesOf(const LeafMask& mask, const std::string& source) {
  const std::vector<Outline> outlines = outlinesOf(mask);
  if (outlines.empty())
    throw InvalidInput(source + ": mask of " + std::to_string(mask.width) + " x " + std::to_string(mask.height) +
                       " pixels: must have leaf somewhere");
  std::size_t corners = 0;
  for (const Outline& outline : outlines) corners += outline.size();
  // 7 x 7 pixels of an image of 512 x 512: leaves keep their lobes.
  const double usual = std::max(0.5, 2e-4 * mask.width * mask.height);
  for (const double share : {1., 0.25, 2., 4., 8., 16.}) {
    if (corners > kMostPixelCorners) break;
    std::optional<MaskTriangles> cut = triangulated(outlines, usual * share);
    if (!cut) continue;
    for (glm::dvec2& corner : cut->corners) corner = {corner.x / mask.width, 1. - corner.y / mask.height};
    for (glm::uvec3& t : cut->triangles) std::swap(t.y, t.z);  // y down has become v up
    return *std::move(cut);
  }
  throw InvalidInput(source + ": mask of " + std::to_string(mask.width) + " x " + std::to_string(mask.height) +
                     " pixels: is too torn to be cut into few triangles: must be taken as it is (--cards mask)");
}

}  // namespace sunfleck::detail
