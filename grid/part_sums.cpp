#include "grid/detail/part_sums.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>

#include "grid/detail/part_walk.hpp"

namespace sunfleck::detail {
namespace {

constexpr std::size_t kShares = 2;  // of the lines, each with sums of its own: a fixed number, for the same bits
constexpr float kInfinity = std::numeric_limits<float>::infinity();

typedef float Four __attribute__((vector_size(16)));

// What some lines pass.
struct Passed {
  std::size_t lanes;
  std::vector<float> begin, end, length;
  std::vector<std::int32_t> count, part;

  Passed(std::size_t of_lanes, std::size_t most_steps)
      : lanes(of_lanes), begin(lanes), end(lanes * most_steps), length(end.size()), count(lanes), part(end.size()) {}
  PassedParts room() { return {begin.data(), count.data(), part.data(), end.data(), length.data()}; }
};

// Sums of a share of the lines. A line that grazes the box's rim may by rounding go on beside it for a millionth of a
// part: there is room for that before the first part and behind the last.
struct Share {
  std::ptrdiff_t room;
  std::vector<Four> sums;  // length, before times length, all times length
  std::vector<glm::vec2> wood;

  Share(const CellGrid& parts, bool with_wood) : room(parts.size.x * (parts.size.y + 1) + 1) {
    const std::size_t count = parts.number({0, 0, parts.size.z}) + 2 * static_cast<std::size_t>(room);
    sums.resize(count, Four{});
    if (with_wood) wood.resize(count, glm::vec2(0.f));
  }
  std::size_t at(std::int32_t part) const { return static_cast<std::size_t>(room + part); }
};

// What wood there is on a line, as depths along it [m].
struct Wood {
  float first = kInfinity, last = -kInfinity;
};

void addLine(const Passed& passed, std::size_t lane, std::span<const Crossing> line, const Wood& wood, Share& share) {
  const auto count = static_cast<std::size_t>(passed.count[lane]) * passed.lanes;
  if (line.empty())
    for (std::size_t i = lane; i < count; i += passed.lanes)
      share.sums[share.at(passed.part[i])][0] += passed.length[i];
  std::size_t met = 0;
  while (met < line.size() && line[met].depth < passed.begin[lane]) ++met;
  Four per_metre{1.f, static_cast<float>(met), static_cast<float>(line.size()), 0.f};
  for (std::size_t i = lane; i < count && !line.empty(); i += passed.lanes) {
    Four& sum = share.sums[share.at(passed.part[i])];
    sum += per_metre * passed.length[i];
    if (met == line.size() || !(line[met].depth < passed.end[i])) continue;
    float before = 0.f;
    for (; met < line.size() && line[met].depth < passed.end[i]; ++met) before += passed.end[i] - line[met].depth;
    sum += Four{0.f, before, 0.f, 0.f};
    per_metre = Four{1.f, static_cast<float>(met), static_cast<float>(line.size()), 0.f};
  }
  if (wood.first == kInfinity) return;
  for (std::size_t i = lane; i < count; i += passed.lanes) {
    const float begin = passed.end[i] - passed.length[i];
    share.wood[share.at(passed.part[i])] += glm::vec2(std::max(0.f, passed.end[i] - std::max(begin, wood.first)),
                                                      std::max(0.f, std::min(passed.end[i], wood.last) - begin));
  }
}

}  // namespace

PartSums& PartSums::operator+=(const PartSums& other) {
  length += other.length;
  before += other.before;
  beyond += other.beyond;
  behind_first_wood += other.behind_first_wood;
  before_last_wood += other.before_last_wood;
  return *this;
}

std::vector<PartSums> sumsOverParts(const CellGrid& parts, const DeepOpacityMap& map, int every) {
  // The parts may reach beyond the map, whose pixels cover the tree: the lines there meet no leaf.
  Bounds shadow;
  for (int corner = 0; corner < 8; ++corner) {
    const Bounds box = parts.box();
    shadow.include(map.inMap({corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                              corner & 4 ? box.high.z : box.low.z}));
  }
  const float line_step = map.pixelSize() * static_cast<float>(every);
  const glm::ivec2 first(glm::floor((glm::vec2(shadow.low) - map.corner()) / line_step));
  const glm::ivec2 last(glm::ceil((glm::vec2(shadow.high) - map.corner()) / line_step));
  const bool with_wood = !map.lastWoodDepth().empty();
  std::vector<Share> shares(kShares, Share(parts, with_wood));
  const PartGrid grid{.low = parts.low, .high = parts.box().high, .side = parts.cell_size, .size = parts.size};
  const PartWalk walk = partWalk();
  tbb::parallel_for(std::size_t{0}, kShares, [&](std::size_t number) {
    Share& share = shares[number];
    Passed passed(walk.lanes, grid.mostSteps());
    std::vector<float> from(3 * walk.lanes);
    const auto lanes = static_cast<int>(walk.lanes);
    // Rows in turn: all shares are alike in work.
    for (int row = first.y + static_cast<int>(number); row <= last.y; row += static_cast<int>(kShares))
      for (int column = first.x; column <= last.x; column += lanes) {
        const auto xOf = [&](int lane) { return (column + lane) * every + every / 2; };
        const int y = row * every + every / 2;
        for (int lane = 0; lane < lanes; ++lane) {
          const glm::vec3 place = map.inSpace(xOf(lane), y, 0.f);
          for (int axis = 0; axis < 3; ++axis) from[static_cast<std::size_t>(axis * lanes + lane)] = place[axis];
        }
        walk.walk(grid, map.along(), from.data(), passed.room());
        for (int lane = 0; lane < lanes && column + lane <= last.x; ++lane) {
          const int x = xOf(lane);
          const bool in_map = x >= 0 && y >= 0 && x < map.size().x && y < map.size().y;
          Wood wood;
          if (in_map && with_wood) {
            const auto pixel =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(map.size().x) + static_cast<std::size_t>(x);
            wood = {map.woodDepth()[pixel], map.lastWoodDepth()[pixel]};
          }
          addLine(passed, static_cast<std::size_t>(lane), in_map ? map.crossings(x, y) : std::span<const Crossing>{},
                  wood, share);
        }
      }
  });
  std::vector<PartSums> sums(parts.number({0, 0, parts.size.z}));
  for (const Share& share : shares)
    for (std::size_t part = 0; part < sums.size(); ++part) {
      const std::size_t at = share.at(static_cast<std::int32_t>(part));
      PartSums of_share{
          .length = share.sums[at][0], .before = share.sums[at][1], .beyond = share.sums[at][2] - share.sums[at][1]};
      if (with_wood) {
        of_share.behind_first_wood = share.wood[at].x;
        of_share.before_last_wood = share.wood[at].y;
      }
      sums[part] += of_share;
    }
  return sums;
}

}  // namespace sunfleck::detail
