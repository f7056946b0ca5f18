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
    for (std::size_t a = 0; a < lines.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) {
        const glm::vec3 apart = per_metre * (lines[a].place - lines[b].place);
        const float square = glm::dot(apart, apart);
        const bool same = lines[a].leaf == lines[b].leaf && lines[a].leaf != kOther;
        all += 1.;
        all_same += same;
        meet += 0.5 * ((lines[a].leaf != kOther) + (lines[b].leaf != kOther));
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
  constexpr std::uint32_t kNone = ~0u;
  std::vector<std::uint32_t> view_of(elements.leaf_elements, kNone);
  std::vector<std::uint32_t> viewed;
  for (std::size_t i = 0; i < elements.leaf_elements; ++i)
    if (scattered(elements.centre[i]) * sides <= sides_wanted) {
      view_of[i] = static_cast<std::uint32_t>(viewed.size());
      viewed.push_back(static_cast<std::uint32_t>(i));
    }
  // What a place sees stands where it is seen from. Chunks are put together in their order, so that sums are too.
  struct Found {
    std::uint32_t view;
    Line line;
  };
  std::array<std::vector<Found>, kChunks> found;
  tbb::parallel_for(std::size_t{0}, kChunks, [&](std::size_t chunk) {
    const auto add = [&](std::size_t side, std::uint32_t crossing, std::uint32_t leaf) {
      const std::size_t element = side / 2;
      if (element >= view_of.size() || view_of[element] == kNone) return;
      const glm::vec3 place = exchange.places.place(exchange.crossed_at[crossing]);
      // Other bits than the side's.
      if (scattered(place + 1.f) * exchange.lines[element] > lines_wanted) return;
      found[chunk].push_back({static_cast<std::uint32_t>(2 * view_of[element] + side % 2), {place, leaf}});
    };
    for (std::size_t side = chunk * exchange.sides() / kChunks; side < (chunk + 1) * exchange.sides() / kChunks;
         ++side) {
      const std::uint32_t leaf = side / 2 < elements.leaf_elements ? elements.leaf[side / 2] : kOther;
      for (std::uint64_t i = exchange.first[side]; i < exchange.first[side + 1]; ++i)
        add(exchange.sees[i], exchange.seen_at[i], leaf);
      for (std::uint64_t i = exchange.first_outside[side]; i < exchange.first_outside[side + 1]; ++i)
        add(side, exchange.open_at[i], kOther);
    }
  });
  std::vector<std::vector<Line>> views(2 * viewed.size());
  for (const std::vector<Found>& of_chunk : found)
    for (const Found& one : of_chunk) views[one.view].push_back(one.line);
  std::vector<std::array<Pairs, kChunks>> parts(count);
  tbb::parallel_for(std::size_t{0}, kChunks, [&](std::size_t chunk) {
    for (std::size_t i = chunk * views.size() / kChunks; i < (chunk + 1) * views.size() / kChunks; ++i) {
      const std::uint32_t element = viewed[i / 2];
      parts[kinds[element]][chunk].add(views[i], 1.f / std::sqrt(elements.area[element]));
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
