#include "plants/detail/mask_outline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <queue>
#include <unordered_map>

namespace sunfleck::detail {
namespace {

double cross(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

// Follows edges of pixels with leaf on the right. A corner of pixels has at most two edges that leave it.
class EdgeFollower {
 public:
  explicit EdgeFollower(const LeafMask& mask)
      : mask_(mask), left_(static_cast<std::size_t>(mask.width + 1) * static_cast<std::size_t>(mask.height + 1), 0) {
    for (int y = 0; y < mask.height; ++y)
      for (int x = 0; x < mask.width; ++x) {
        if (!opaque(x, y)) continue;
        if (!opaque(x, y - 1)) left_[at(x, y)] |= 1u << kEast;
        if (!opaque(x + 1, y)) left_[at(x + 1, y)] |= 1u << kSouth;
        if (!opaque(x, y + 1)) left_[at(x + 1, y + 1)] |= 1u << kWest;
        if (!opaque(x - 1, y)) left_[at(x, y + 1)] |= 1u << kNorth;
      }
  }

  std::vector<Outline> outlines() {
    std::vector<Outline> all;
    for (int y = 0; y <= mask_.height; ++y)
      for (int x = 0; x <= mask_.width; ++x)
        while (left_[at(x, y)] != 0) all.push_back(follow(x, y));
    return all;
  }

 private:
  static constexpr int kEast = 0, kSouth = 1, kWest = 2, kNorth = 3;

  bool opaque(int x, int y) const {
    return x >= 0 && y >= 0 && x < mask_.width && y < mask_.height &&
           mask_.opaque[static_cast<std::size_t>(y) * static_cast<std::size_t>(mask_.width) +
                        static_cast<std::size_t>(x)] != 0;
  }
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(mask_.width + 1) + static_cast<std::size_t>(x);
  }

  Outline follow(int x, int y) {
    constexpr std::array<int, 4> kRight{1, 0, -1, 0}, kDown{0, 1, 0, -1};
    Outline outline;
    const std::size_t start = at(x, y);
    int first = 0;
    while (((std::uint32_t{left_[start]} >> first) & 1u) == 0u) ++first;
    for (int direction = first;;) {
      outline.emplace_back(x, y);
      do {
        left_[at(x, y)] = static_cast<std::uint8_t>(left_[at(x, y)] & ~(1u << direction));
        x += kRight[static_cast<std::size_t>(direction)];
        y += kDown[static_cast<std::size_t>(direction)];
      } while (at(x, y) != start && left_[at(x, y)] == 1u << direction);
      // Around the same pixel first: a turn to the right.
      for (const int turn : {1, 0, 3}) {
        const int next = (direction + turn) & 3;
        if (at(x, y) == start && next == first) return outline;
        if (((std::uint32_t{left_[at(x, y)]} >> next) & 1u) == 0u) continue;
        direction = next;
        break;
      }
    }
  }

  const LeafMask& mask_;
  std::vector<std::uint8_t> left_;  // directions of edges not yet followed, of each corner of pixels
};

// The corner that takes the place of B and C, and the area over which the line then moves.
struct Collapse {
  glm::dvec2 corner{0.};
  double moved = std::numeric_limits<double>::infinity();
};

Collapse collapseOf(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& d) {
  const glm::dvec2 base = d - a;
  const double of_b = cross(base, b - a), of_c = cross(base, c - a);  // heights over AD, times its length
  // Twice the area between A B C D and AD, which the triangle A E D is to have.
  const double twice = cross(b - a, c - a) + cross(c - a, d - a);
  const double of_e = -twice;
  const bool same_side = (of_b >= 0.) == (of_c >= 0.);
  const bool along_ab = same_side ? std::abs(of_b) > std::abs(of_c) : (of_e >= 0.) == (of_b >= 0.);
  Collapse collapse;
  if (glm::dot(base, base) < 1e-12) return collapse;
  if (along_ab) {
    if (of_b == 0.) return collapse;
    collapse.corner = a + of_e / of_b * (b - a);
  } else {
    if (of_c == 0.) return collapse;
    collapse.corner = d + of_e / of_c * (c - d);
  }
  // Of lines nearly along AD the new corner may lie anywhere.
  const double length = glm::distance(a, b) + glm::distance(b, c) + glm::distance(c, d);
  if (!(glm::distance(collapse.corner, b) <= length)) return collapse;
  collapse.moved = std::abs(cross(c - b, collapse.corner - b));
  return collapse;
}

bool crosses(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& d) {
  const double of_c = cross(b - a, c - a), of_d = cross(b - a, d - a);
  const double of_a = cross(d - c, a - c), of_b = cross(d - c, b - c);
  if (std::max(a.x, b.x) < std::min(c.x, d.x) || std::max(c.x, d.x) < std::min(a.x, b.x) ||
      std::max(a.y, b.y) < std::min(c.y, d.y) || std::max(c.y, d.y) < std::min(a.y, b.y))
    return false;
  return of_c * of_d <= 0. && of_a * of_b <= 0.;
}

// All outlines at once, so that none comes to cross itself or another.
class Simplifier {
 public:
  explicit Simplifier(std::vector<Outline>& outlines) : outlines_(outlines) {
    for (std::size_t outline = 0; outline < outlines.size(); ++outline) {
      const std::size_t first = corners_.size(), count = outlines[outline].size();
      for (std::size_t i = 0; i < count; ++i)
        corners_.push_back({outlines[outline][i], first + (i + count - 1) % count, first + (i + 1) % count, outline});
      count_.push_back(count);
    }
    for (std::size_t i = 0; i < corners_.size(); ++i) enter(i);
  }

  void run(double most) {
    for (std::size_t i = 0; i < corners_.size(); ++i) offer(i, most);
    while (!waiting_.empty()) {
      const Offer offered = waiting_.top();
      waiting_.pop();
      const std::size_t b = offered.first;
      if (!corners_[b].stays || corners_[b].version != offered.version) continue;
      if (count_[corners_[b].outline] <= 4 || !isFree(b, offered.collapse.corner)) continue;
      const std::size_t c = corners_[b].next, d = corners_[c].next, a = corners_[b].before;
      corners_[b].at = offered.collapse.corner;
      corners_[c].stays = false;
      corners_[b].next = d;
      corners_[d].before = b;
      --count_[corners_[b].outline];
      enter(a);
      enter(b);
      for (const std::size_t touched : {corners_[a].before, a, b, d}) {
        ++corners_[touched].version;
        offer(touched, most);
      }
    }
    for (Outline& outline : outlines_) outline.clear();
    for (const Corner& corner : corners_)
      if (corner.stays) outlines_[corner.outline].push_back(corner.at);
  }

 private:
  struct Corner {
    glm::dvec2 at;
    std::size_t before, next, outline;
    std::uint32_t version = 0;
    bool stays = true;
  };
  struct Offer {
    Collapse collapse;
    std::size_t first;  // B
    std::uint32_t version;
    bool operator<(const Offer& other) const {
      return collapse.moved != other.collapse.moved ? collapse.moved > other.collapse.moved : first > other.first;
    }
  };
  static constexpr double kCell = 8.;  // of the grid that finds neighbours [pixel]

  void offer(std::size_t b, double most) {
    const std::size_t c = corners_[b].next;
    const Collapse collapse =
        collapseOf(corners_[corners_[b].before].at, corners_[b].at, corners_[c].at, corners_[corners_[c].next].at);
    if (collapse.moved <= most) waiting_.push({collapse, b, corners_[b].version});
  }

  // Calls for each cell of the grid over the box of some points.
  template <typename Points, typename Take>
  static void forCells(const Points& points, const Take& take) {
    glm::dvec2 low = *points.begin(), high = low;
    for (const glm::dvec2& p : points) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
    for (auto y = static_cast<std::int64_t>(std::floor(low.y / kCell)); static_cast<double>(y) * kCell <= high.y; ++y)
      for (auto x = static_cast<std::int64_t>(std::floor(low.x / kCell)); static_cast<double>(x) * kCell <= high.x; ++x)
        take(y * (std::int64_t{1} << 32) + x);
  }

  // The edge that leaves a corner; what was entered of it before stays and is seen through by isFree().
  void enter(std::size_t i) {
    forCells(std::array{corners_[i].at, corners_[corners_[i].next].at},
             [&](std::int64_t cell) { edges_[cell].push_back(i); });
  }

  // Whether no other edge crosses the way over the new corner, nor lies between that and the old one.
  bool isFree(std::size_t b, const glm::dvec2& corner) const {
    const std::size_t a = corners_[b].before, c = corners_[b].next, d = corners_[c].next;
    const std::array<glm::dvec2, 5> swept{corners_[a].at, corners_[b].at, corners_[c].at, corners_[d].at, corner};
    bool free = true;
    forCells(swept, [&](std::int64_t cell) {
      const auto found = edges_.find(cell);
      if (!free || found == edges_.end()) return;
      for (const std::size_t i : found->second) {
        if (!corners_[i].stays || i == a || i == b || i == c) continue;
        const std::size_t end = corners_[i].next;
        const glm::dvec2 &from = corners_[i].at, &to = corners_[end].at;
        // The neighbours meet the way at A and at D in any case.
        const bool meets =
            (end != a && crosses(swept[0], corner, from, to)) || (i != d && crosses(corner, swept[3], from, to));
        const bool between = i != d && contains(swept, from);
        if (meets || between) {
          free = false;
          return;
        }
      }
    });
    return free;
  }

  std::vector<Outline>& outlines_;
  std::vector<Corner> corners_;
  std::vector<std::size_t> count_;                                    // of the corners of each outline that stay
  std::unordered_map<std::int64_t, std::vector<std::size_t>> edges_;  // by their first corners
  std::priority_queue<Offer> waiting_;
};

}  // namespace

bool contains(std::span<const glm::dvec2> outline, const glm::dvec2& p) {
  bool odd = false;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2 &a = outline[i], &b = outline[(i + 1) % outline.size()];
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) odd = !odd;
  }
  return odd;
}

double signedArea(const Outline& outline) {
  double twice = 0.;
  for (std::size_t i = 0; i < outline.size(); ++i)
    twice += cross(outline[i] - outline[0], outline[(i + 1) % outline.size()] - outline[0]);
  return 0.5 * twice;
}

std::vector<Outline> outlinesOf(const LeafMask& mask) {
  return EdgeFollower(mask).outlines();
}

void simplify(std::vector<Outline>& outlines, double most) {
  Simplifier(outlines).run(most);
}

}  // namespace sunfleck::detail
