#include "field/line_exchange.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>
#include <string>

#include "core/available_memory.hpp"
#include "core/bounds.hpp"
#include "core/require.hpp"
#include "core/shared_progress.hpp"
#include "field/detail/line_grid.hpp"

namespace sunfleck {
namespace {

using detail::Crossing64;
using detail::LineGrid;
using detail::sideMet;

constexpr double kMostLines = 16'777'216.;        // along an axis
constexpr double kMostCrossings = 4e9;            // which have numbers of 32 bits
constexpr std::size_t kChunks = 16;               // of axes, whose links are counted and written one after the other
constexpr std::uint32_t kFirstOnLine = 1u << 31;  // marks a side, of which there are fewer

// What the lines along one axis cross: the sides they come to and where, line by line; lines that cross nothing left
// out.
struct AxisCrossings {
  std::vector<std::uint32_t> sides;
  std::vector<glm::u16vec3> places;
  std::uint64_t lines = 0, free_lines = 0;
};

// Memory that a thread uses for one axis after another.
struct Work {
  std::vector<detail::Span> spans;
  std::vector<std::pair<std::uint32_t, Crossing64>> found;
  std::vector<std::uint32_t> next;
  std::vector<Crossing64> sorted;
};

void sortLine(Crossing64* begin, Crossing64* end) {
  if (end - begin > 24) return std::sort(begin, end);
  for (Crossing64* i = begin; i < end; ++i) {
    const Crossing64 moved = *i;
    Crossing64* place = i;
    for (; place > begin && moved < place[-1]; --place) *place = place[-1];
    *place = moved;
  }
}

AxisCrossings crossingsAlong(const LineGrid& grid, const PlaceCode& places, Work& work) {
  work.found.clear();
  work.next.assign(grid.lines() + 1, 0);
  grid.cross(0, grid.triangles(), work.spans, [&](std::size_t line, Crossing64 crossing) {
    work.found.emplace_back(static_cast<std::uint32_t>(line), crossing);
    ++work.next[line];
  });
  std::uint32_t sum = 0;
  for (std::uint32_t& next : work.next) sum += std::exchange(next, sum);
  work.sorted.resize(work.found.size());
  for (const auto& [line, crossing] : work.found) work.sorted[work.next[line]++] = crossing;
  AxisCrossings result{.sides = {}, .places = {}, .lines = grid.lines()};
  result.sides.reserve(work.found.size());
  result.places.reserve(work.found.size());
  std::uint32_t begin = 0;
  int column = 0, row = 0;
  for (std::size_t line = 0; line < grid.lines(); ++line, ++column) {
    if (column == grid.size().x) {
      column = 0;
      ++row;
    }
    const std::uint32_t end = work.next[line];
    if (begin == end) {
      ++result.free_lines;
      continue;
    }
    sortLine(&work.sorted[begin], work.sorted.data() + end);
    for (std::uint32_t i = begin; i < end; ++i) {
      result.sides.push_back(sideMet(work.sorted[i]) | (i == begin ? kFirstOnLine : 0));
      result.places.push_back(places.code(grid.place(column, row, detail::depthOf(work.sorted[i]))));
    }
    begin = end;
  }
  return result;
}

// The upper half of spherical Fibonacci points (Swinbank & Purser 2006): evenly spread, and evenly in height, which
// level layers ask for.
std::vector<Direction> axesOf(int count) {
  const double golden_angle = std::numbers::pi * (3. - std::sqrt(5.));
  std::vector<Direction> axes;
  for (int i = 0; i < count; ++i) {
    const double z = 1. - (2. * i + 1.) / (2. * count), r = std::sqrt(1. - z * z);
    axes.push_back(
        glm::normalize(glm::vec3(glm::dvec3(r * std::cos(golden_angle * i), r * std::sin(golden_angle * i), z))));
  }
  return axes;
}

double totalArea(const FieldElements& elements) {
  return std::accumulate(elements.area.begin(), elements.area.end(), 0.);
}

// A chunk's share of the links of each side, met and outside, and of the crossings of each element; then where its next
// one goes.
struct ChunkLinks {
  std::vector<std::uint32_t> met, outside, crossings;
};

// Calls link(side, source, i of the source) and outside(side, direction, i of the side) for what each side sees on the
// lines along an axis, of its crossings i.
template <typename Link, typename Outside>
void forLinks(const AxisCrossings& axis, std::size_t number, std::size_t axes, const Link& link,
              const Outside& outside) {
  const auto along = static_cast<std::uint16_t>(number), against = static_cast<std::uint16_t>(axes + number);
  const std::size_t count = axis.sides.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t side = axis.sides[i] & ~kFirstOnLine;
    if (axis.sides[i] & kFirstOnLine)
      outside(side, along, i);
    else
      link(side, (axis.sides[i - 1] & ~kFirstOnLine) ^ 1u, i - 1);
    if (i + 1 == count || axis.sides[i + 1] & kFirstOnLine)
      outside(side ^ 1u, against, i);
    else
      link(side ^ 1u, axis.sides[i + 1], i + 1);
  }
}

}  // namespace

PlaceCode::PlaceCode(const TreeMesh& mesh, const std::optional<glm::vec2>& period) : periodic_(period.has_value()) {
  const Bounds box = bounds(mesh);
  glm::vec3 size = glm::max(box.size(), glm::vec3(1e-6f));
  if (period) size = {period->x, period->y, size.z};
  low_ = box.low;
  per_metre_ = 65'536.f / size;
}

std::size_t LineExchange::memoryBytes() const {
  return 8 * (first.size() + first_outside.size()) +
         4 * (sees.size() + seen_at.size() + open_at.size() + lines.size() + below.size() + first_crossing.size()) +
         2 * outside.size() + sizeof(glm::u16vec3) * crossed_at.size();
}

// (F2)
LineExchange lineExchange(const TreeMesh& mesh, const FieldElements& elements, const std::optional<glm::vec2>& period,
                          const ExchangeEffort& effort, const Progress& progress) {
  require(elements.leaf_elements > 0, "number of leaves", elements.leaf_elements, "at least 1");
  require(effort.axes >= 1 && effort.axes <= 16'384, "axes of the exchange", effort.axes, "1 .. 16384");
  require(effort.crossings > 0.f && effort.crossings <= 1e4f, "crossings of the exchange", effort.crossings,
          "above 0 and at most 1e4");
  const auto axes = static_cast<std::size_t>(effort.axes);
  const double total = totalArea(elements);
  // A line crosses an element of area A turned any way with probability A / 2 per its own area.
  const double leaves = std::accumulate(
      elements.area.begin(), elements.area.begin() + static_cast<std::ptrdiff_t>(elements.leaf_elements), 0.);
  const double area = std::min(leaves / static_cast<double>(mesh.leaf_count),
                               2. * leaves / static_cast<double>(elements.leaf_elements));
  // Of small leaves far apart lines would be too many: most of them meet nothing.
  const glm::dvec3 box(bounds(mesh).size());
  const double across = period ? double{period->x} * double{period->y} : box.x * box.y + box.y * box.z + box.z * box.x;
  const double line_area = std::max(0.5 * area / double{effort.crossings}, across / kMostLines);
  // With a period as small as that there is one line for it.
  const double crossings = 0.5 * total / (period ? std::min(line_area, across) : line_area) * static_cast<double>(axes);
  const double bytes = crossings * 56. + static_cast<double>(elements.size()) * (20. * kChunks + 60.) +
                       8. * across / std::min(line_area, across) * static_cast<double>(kChunks);
  if (const double available = availableMemory(); bytes > available)
    throw InvalidInput("the light field: must be of fewer leaves or lines: it would take " +
                       std::to_string(static_cast<long long>(bytes * 1e-6)) + " MB, and there are " +
                       std::to_string(static_cast<long long>(available * 1e-6)) + " MB");
  if (crossings > kMostCrossings)
    throw InvalidInput("the light field: must be of fewer leaves or lines: these would meet " +
                       std::to_string(static_cast<long long>(crossings)) + " times, and 4000000000 times are the most");

  const std::vector<Direction> along = axesOf(effort.axes);
  const detail::StandSurfaces surfaces{&mesh, &elements, period};
  std::vector<AxisCrossings> found(axes);
  LineExchange exchange;
  exchange.places = PlaceCode(mesh, period);
  const std::size_t sides = 2 * elements.size();
  std::vector<ChunkLinks> chunks(kChunks);
  const auto axesOfChunk = [&](std::size_t chunk) {
    return std::pair(chunk * axes / kChunks, (chunk + 1) * axes / kChunks);
  };
  SharedProgress axes_done(progress, 2. * static_cast<double>(axes));
  tbb::parallel_for(std::size_t{0}, kChunks, [&](std::size_t chunk) {
    Work work;
    ChunkLinks& links = chunks[chunk];
    links.met.resize(sides);
    links.outside.resize(sides);
    links.crossings.resize(elements.size());
    const auto [begin, end] = axesOfChunk(chunk);
    for (std::size_t axis = begin; axis < end; ++axis) {
      // Offsets by the R2 sequence (Roberts 2018), so that no place is missed by all axes.
      const auto number = static_cast<double>(axis) + 0.5;
      const glm::dvec2 offset(number * 0.7548776662466927, number * 0.5698402909980532);
      found[axis] = crossingsAlong(LineGrid(surfaces, along[axis], line_area, offset - glm::floor(offset)),
                                   exchange.places, work);
      forLinks(
          found[axis], axis, axes, [&](std::uint32_t side, std::uint32_t, std::size_t) { ++links.met[side]; },
          [&](std::uint32_t side, std::uint16_t, std::size_t) { ++links.outside[side]; });
      for (const std::uint32_t side : found[axis].sides) ++links.crossings[(side & ~kFirstOnLine) / 2];
      axes_done.add();
    }
  });

  const auto starts = [&](auto& first, std::vector<std::uint32_t> ChunkLinks::*counts) {
    using Number = std::decay_t<decltype(first[0])>;
    const std::size_t members = (chunks.front().*counts).size();
    first.resize(members + 1);
    Number sum = 0;
    for (std::size_t i = 0; i < members; ++i) {
      first[i] = sum;
      std::uint32_t before = 0;
      for (ChunkLinks& chunk : chunks) before += std::exchange((chunk.*counts)[i], before);
      sum += before;
    }
    first[members] = sum;
    return sum;
  };
  exchange.sees.resize(starts(exchange.first, &ChunkLinks::met));
  exchange.outside.resize(starts(exchange.first_outside, &ChunkLinks::outside));
  exchange.crossed_at.resize(starts(exchange.first_crossing, &ChunkLinks::crossings));
  exchange.seen_at.resize(exchange.sees.size());
  exchange.open_at.resize(exchange.outside.size());
  tbb::parallel_for(std::size_t{0}, kChunks, [&](std::size_t chunk) {
    ChunkLinks& links = chunks[chunk];
    std::vector<std::uint32_t> crossing;  // number of each of an axis
    const auto [begin, end] = axesOfChunk(chunk);
    for (std::size_t axis = begin; axis < end; ++axis) {
      crossing.resize(found[axis].sides.size());
      for (std::size_t i = 0; i < crossing.size(); ++i) {
        const std::uint32_t element = (found[axis].sides[i] & ~kFirstOnLine) / 2;
        crossing[i] = exchange.first_crossing[element] + links.crossings[element]++;
        exchange.crossed_at[crossing[i]] = found[axis].places[i];
      }
      forLinks(
          found[axis], axis, axes,
          [&](std::uint32_t side, std::uint32_t source, std::size_t i) {
            const std::uint64_t link = exchange.first[side] + links.met[side]++;
            exchange.sees[link] = source;
            exchange.seen_at[link] = crossing[i];
          },
          [&](std::uint32_t side, std::uint16_t direction, std::size_t i) {
            const std::uint64_t link = exchange.first_outside[side] + links.outside[side]++;
            exchange.outside[link] = direction;
            exchange.open_at[link] = crossing[i];
          });
      axes_done.add();
    }
  });
  exchange.lines.resize(elements.size());
  for (std::size_t i = 0; i < elements.size(); ++i)
    exchange.lines[i] = exchange.first_crossing[i + 1] - exchange.first_crossing[i];
  exchange.directions = along;
  for (const Direction& axis : along) exchange.directions.push_back(-axis);
  exchange.below.resize(sides);
  for (std::size_t side = 0; side < sides; ++side)
    for (std::uint64_t i = exchange.first_outside[side]; i < exchange.first_outside[side + 1]; ++i)
      exchange.below[side] += exchange.directions[exchange.outside[i]].z > 0.f;
  for (const AxisCrossings& axis : found) exchange.all_lines += axis.lines;
  for (const AxisCrossings& axis : found) exchange.free_lines.push_back(axis.free_lines);
  exchange.line_power = line_area * 4. * std::numbers::pi / (2. * static_cast<double>(axes));
  return exchange;
}

}  // namespace sunfleck
