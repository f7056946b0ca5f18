#include "field/near_return.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

namespace sunfleck {
namespace {

constexpr std::size_t kSides = 16'384;  // that are looked at, about
constexpr std::uint32_t kLines = 16;    // of a side that are paired, about
constexpr std::size_t kRoom = 32;       // for them
constexpr float kNear = 0.5f;           // distance at which two lines are near [square roots of the element's area]
constexpr std::uint32_t kOutside = ~0u;  // or wood: not asked for

// Where a line leaves a side, and the leaf that it meets.
struct Line {
  glm::vec3 place;
  std::uint32_t leaf;
};

// Lines of a side, thinned out.
struct View {
  std::array<Line, kRoom> lines;
  std::size_t count = 0;
  void add(const Line& line) {
    if (count < kRoom) lines[count++] = line;
  }
};

// Of pairs of lines from one side, how often both meet the same leaf: over all pairs, and by a straight line over the
// distance of near ones.
struct Pairs {
  double all = 0., all_same = 0., meet = 0.;
  double near = 0., near_same = 0., distance = 0., squares = 0., same_distance = 0.;

  void add(const View& view, float per_metre) {
    for (std::size_t a = 0; a < view.count; ++a)
      for (std::size_t b = 0; b < a; ++b) {
        const double d = double{per_metre * glm::distance(view.lines[a].place, view.lines[b].place)};
        const bool same = view.lines[a].leaf == view.lines[b].leaf && view.lines[a].leaf != kOutside;
        all += 1.;
        meet += 0.5 * ((view.lines[a].leaf != kOutside) + (view.lines[b].leaf != kOutside));
        all_same += same;
        if (d > double{kNear}) continue;
        near += 1.;
        near_same += same;
        distance += d;
        squares += d * d;
        same_distance += same ? d : 0.;
      }
  }

  double excess() const {
    const double spread = near * squares - distance * distance;
    if (!(spread > 1e-6 * near * squares)) return 0.;
    const double from_one_place = (near_same * squares - distance * same_distance) / spread;
    return std::clamp((from_one_place * all - all_same) / std::max(meet, 1.), 0., 1.);
  }
};

// Scatters whole numbers evenly (Steele, Lea & Flood 2014).
std::uint32_t mixed(std::uint64_t number) {
  number = (number ^ (number >> 30)) * 0xbf58476d1ce4e5b9u;
  number = (number ^ (number >> 27)) * 0x94d049bb133111ebu;
  return static_cast<std::uint32_t>(number >> 32);
}

}  // namespace

// (F7)
std::vector<float> nearReturn(const FieldElements& elements, const LineExchange& exchange,
                              std::span<const std::uint32_t> kinds, std::size_t count) {
  const std::size_t sides = 2 * elements.leaf_elements, step = (sides + kSides - 1) / kSides;
  std::vector<View> views((sides + step - 1) / step);
  const auto add = [&](std::size_t side, std::uint64_t number, const glm::u16vec3& place, std::uint32_t leaf) {
    if (side >= sides || side % step != 0) return;
    if (std::uint64_t{mixed(number)} * exchange.lines[side / 2] >> 32 >= kLines) return;
    views[side / step].add({exchange.places.place(place), leaf});
  };
  // What a place sees stands where it is seen from.
  for (std::size_t side = 0; side < exchange.sides(); ++side) {
    const std::uint32_t leaf = side < sides ? elements.leaf[side / 2] : kOutside;
    for (std::uint64_t i = exchange.first[side]; i < exchange.first[side + 1]; ++i)
      add(exchange.sees[i], 2 * i, exchange.seen_at[i], leaf);
    for (std::uint64_t i = exchange.first_outside[side]; i < exchange.first_outside[side + 1]; ++i)
      add(side, 2 * i + 1, exchange.open_at[i], kOutside);
  }
  std::vector<Pairs> pairs(count);
  for (std::size_t i = 0; i < views.size(); ++i) {
    const std::size_t element = i * step / 2;
    pairs[kinds[element]].add(views[i], 1.f / std::sqrt(elements.area[element]));
  }
  std::vector<float> shares;
  for (const Pairs& of_kind : pairs) shares.push_back(static_cast<float>(of_kind.excess()));
  return shares;
}

}  // namespace sunfleck
