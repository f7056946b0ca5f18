#include "field/near_return.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>

namespace sunfleck {
namespace {

constexpr double kPairs = 1e6;         // of lines that are looked at, about
constexpr double kLeastLines = 16.;    // of a side, about
constexpr float kNear = 0.5f;          // distance at which two lines are near [square roots of the element's area]
constexpr std::size_t kChunks = 16;    // of work for threads
constexpr std::uint32_t kOther = ~0u;  // what is no leaf

// Where a line leaves a side, and the leaf that it meets.
struct Line {
  glm::vec3 place;
  std::uint32_t leaf;
};

// Of pairs of lines from one side, how often both meet the same leaf: over all pairs, and by a straight line over the
// distance of near ones.
struct Pairs {
  double all = 0., all_same = 0., meet = 0.;
  double near = 0., near_same = 0., distance = 0., squares = 0., same_distance = 0.;

  void add(std::span<const Line> lines, float per_metre) {
    if (lines.empty()) return;
    std::size_t meeting = 0;
    for (const Line& line : lines) meeting += line.leaf != kOther;
    // Each line is one of a pair with all others.
    all += 0.5 * static_cast<double>(lines.size()) * static_cast<double>(lines.size() - 1);
    meet += 0.5 * static_cast<double>(meeting) * static_cast<double>(lines.size() - 1);
    for (std::size_t a = 0; a < lines.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) {
        const glm::vec3 apart = per_metre * (lines[a].place - lines[b].place);
        const float square = glm::dot(apart, apart);
        const bool same = lines[a].leaf == lines[b].leaf && lines[a].leaf != kOther;
        all_same += same;
        if (square > kNear * kNear) continue;
        const double d = double{std::sqrt(square)};
        near += 1.;
        near_same += same;
        distance += d;
        squares += double{square};
        same_distance += same ? d : 0.;
      }
  }

  void add(const Pairs& other) {
    all += other.all;
    all_same += other.all_same;
    meet += other.meet;
    near += other.near;
    near_same += other.near_same;
    distance += other.distance;
    squares += other.squares;
    same_distance += other.same_distance;
  }

  double excess() const {
    const double spread = near * squares - distance * distance;
    if (!(spread > 1e-6 * near * squares)) return 0.;
    const double from_one_place = (near_same * squares - distance * same_distance) / spread;
    return std::clamp((from_one_place * all - all_same) / std::max(meet, 1.), 0., 1.);
  }
};

// Scatters whole numbers evenly (Steele, Lea & Flood 2014), over 0 .. 1.
double scattered(std::uint64_t number) {
  number = (number ^ (number >> 30)) * 0xbf58476d1ce4e5b9u;
  number = (number ^ (number >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>(number >> 33) * 0x1p-31;
}
// By what a place is and not by what number it has: so that the order of leaves and trees does not matter.
double scattered(const glm::vec3& place) {
  return scattered(std::uint64_t{std::bit_cast<std::uint32_t>(place.x)} << 32 ^
                   std::uint64_t{std::bit_cast<std::uint32_t>(place.y)} << 16 ^ std::bit_cast<std::uint32_t>(place.z));
}

}  // namespace

// (F7)
std::vector<float> nearReturn(const FieldElements& elements, const LineExchange& exchange,
                              std::span<const std::uint32_t> kinds, std::size_t count) {
  // Of so many sides, and of so many of their lines, that pairs are as many as wanted.
  const auto sides = static_cast<double>(2 * elements.leaf_elements);
  const double lines_wanted = std::max(kLeastLines, std::sqrt(2. * kPairs / sides));
  const double sides_wanted = 2. * kPairs / (lines_wanted * lines_wanted);
  struct View {
    std::uint32_t element, first, end;  // and its places that are looked from
  };
  std::vector<View> views;
  std::vector<glm::vec3> places;
  constexpr std::uint32_t kNone = ~0u;
  std::vector<std::uint32_t> place_at(exchange.crossed_at.size(), kNone);  // of each crossing
  for (std::uint32_t element = 0; element < elements.leaf_elements; ++element) {
    if (scattered(elements.centre[element]) * sides > sides_wanted) continue;
    const auto first = static_cast<std::uint32_t>(places.size());
    for (std::uint32_t i = exchange.first_crossing[element]; i < exchange.first_crossing[element + 1]; ++i) {
      const glm::vec3 place = exchange.places.place(exchange.crossed_at[i]);
      // Other bits than the element's.
      if (scattered(place + 1.f) * exchange.lines[element] > lines_wanted) continue;
      place_at[i] = static_cast<std::uint32_t>(places.size());
      places.push_back(place);
    }
    views.push_back({element, first, static_cast<std::uint32_t>(places.size())});
  }
  // What a place sees, by front and back, stands where it is seen from.
  std::vector<std::array<std::uint32_t, 2>> met(places.size(), {kOther, kOther});
  tbb::parallel_for(std::size_t{0}, kChunks, [&](std::size_t chunk) {
    for (std::size_t side = chunk * exchange.sides() / kChunks; side < (chunk + 1) * exchange.sides() / kChunks;
         ++side) {
      if (side / 2 >= elements.leaf_elements) break;
      for (std::uint64_t i = exchange.first[side]; i < exchange.first[side + 1]; ++i)
        if (const std::uint32_t place = place_at[exchange.seen_at[i]]; place != kNone)
          met[place][exchange.sees[i] % 2] = elements.leaf[side / 2];
    }
  });
  std::vector<std::array<Pairs, kChunks>> parts(count);
  tbb::parallel_for(std::size_t{0}, kChunks, [&](std::size_t chunk) {
    std::vector<Line> lines;
    for (std::size_t v = chunk * views.size() / kChunks; v < (chunk + 1) * views.size() / kChunks; ++v) {
      const View& view = views[v];
      for (std::size_t back = 0; back < 2; ++back) {
        lines.clear();
        for (std::uint32_t i = view.first; i < view.end; ++i) lines.push_back({places[i], met[i][back]});
        parts[kinds[view.element]][chunk].add(lines, 1.f / std::sqrt(elements.area[view.element]));
      }
    }
  });
  std::vector<float> shares;
  for (const auto& of_kind : parts) {
    Pairs pairs;
    for (const Pairs& part : of_kind) pairs.add(part);
    shares.push_back(static_cast<float>(pairs.excess()));
  }
  return shares;
}

}  // namespace sunfleck
