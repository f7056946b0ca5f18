#include "grid/tree_depths.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace sunfleck {
namespace {

// At most so many of the map's lines to a cell's side are walked. Depths are off by their sampling alone: by 2.7 %
// (RMS, the cherry) with 8 lines to a side, 1.0 % with 16, 0.5 % with 32.
constexpr int kLinesPerCell = 16;
constexpr float kFinestPicture = 2.f;  // as seen from cells so many of the map's pixels wide or narrower
constexpr int kPixelsPerCell = 4;      // of a picture of thickness, to a cell's side

// The part of a line that lies in a box, as distances along it; empty when the first is not the smaller.
glm::vec2 within(const Bounds& box, const glm::vec3& from, const glm::vec3& along) {
  glm::vec2 part(-std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity());
  for (int axis = 0; axis < 3; ++axis) {
    if (along[axis] == 0.f) {
      if (!(from[axis] >= box.low[axis] && from[axis] <= box.high[axis])) return {1.f, 0.f};
      continue;
    }
    const float a = (box.low[axis] - from[axis]) / along[axis], b = (box.high[axis] - from[axis]) / along[axis];
    part = {std::max(part.x, std::min(a, b)), std::min(part.y, std::max(a, b))};
  }
  return part;
}

// Calls visit(cell, begin, end) for the cells that a line passes, `begin` and `end` being distances along it.
template <typename Visit>
void walk(const CellGrid& grid, const glm::vec3& from, const glm::vec3& along, const Visit& visit) {
  const glm::vec2 part = within(grid.box(), from, along);
  if (!(part.x < part.y)) return;
  glm::ivec3 cell = glm::clamp(glm::ivec3(glm::floor((from + part.x * along - grid.low) / grid.cell_size)),
                               glm::ivec3(0), grid.size - 1);
  glm::vec3 next;  // distance at which the line leaves the cell across each axis
  glm::vec3 step;  // distance from one such crossing to the next
  glm::ivec3 turn;
  for (int axis = 0; axis < 3; ++axis) {
    turn[axis] = along[axis] > 0.f ? 1 : -1;
    const float plane = grid.low[axis] + grid.cell_size * static_cast<float>(cell[axis] + (along[axis] > 0.f ? 1 : 0));
    next[axis] = along[axis] == 0.f ? std::numeric_limits<float>::infinity() : (plane - from[axis]) / along[axis];
    step[axis] = along[axis] == 0.f ? 0.f : grid.cell_size / std::abs(along[axis]);
  }
  for (float at = part.x; at < part.y;) {
    const int axis = next.x < next.y ? (next.x < next.z ? 0 : 2) : (next.y < next.z ? 1 : 2);
    const float end = std::clamp(next[axis], at, part.y);
    visit(grid.number(cell), at, end);
    at = end;
    cell[axis] += turn[axis];
    if (cell[axis] < 0 || cell[axis] >= grid.size[axis]) return;
    next[axis] += step[axis];
  }
}

// Sums over all pixels left of and below a corner between pixels, from which the mean over any rectangle follows.
class SummedArea {
 public:
  explicit SummedArea(const DeepOpacityMap& map) : size_(map.size()), sums_(index(0, size_.y + 1), 0.) {
    for (int y = 0; y < size_.y; ++y)
      for (int x = 0; x < size_.x; ++x)
        sums_[index(x + 1, y + 1)] = static_cast<double>(map.crossings(x, y).size()) + sums_[index(x, y + 1)] +
                                     sums_[index(x + 1, y)] - sums_[index(x, y)];
  }
  // The integral over a rectangle, in pixels; what lies beside the map is empty.
  double over(glm::vec2 low, glm::vec2 high) const {
    return upTo(high.x, high.y) - upTo(low.x, high.y) - upTo(high.x, low.y) + upTo(low.x, low.y);
  }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.x + 1) + static_cast<std::size_t>(x);
  }
  double upTo(float right, float above) const {
    const float x = std::clamp(right, 0.f, static_cast<float>(size_.x));
    const float y = std::clamp(above, 0.f, static_cast<float>(size_.y));
    const int column = std::min(static_cast<int>(x), size_.x - 1), row = std::min(static_cast<int>(y), size_.y - 1);
    const double part_x = double{x} - column, part_y = double{y} - row;
    const double low = sums_[index(column, row)] * (1. - part_x) + sums_[index(column + 1, row)] * part_x;
    const double high = sums_[index(column, row + 1)] * (1. - part_x) + sums_[index(column + 1, row + 1)] * part_x;
    return low * (1. - part_y) + high * part_y;
  }

  glm::ivec2 size_;
  std::vector<double> sums_;
};

// Values at the corners of squares, interpolated between them; 0 beside them.
class Lattice {
 public:
  explicit Lattice(glm::ivec2 size)
      : size_(size), values_(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y)) {}
  float& operator()(int x, int y) { return values_[index(x, y)]; }
  float at(glm::vec2 place) const {
    const glm::ivec2 low(glm::floor(place));
    if (low.x < 0 || low.y < 0 || low.x + 1 >= size_.x || low.y + 1 >= size_.y) return 0.f;
    const glm::vec2 part = place - glm::vec2(low);
    const float* const row = &values_[index(low.x, low.y)];
    const float* const next = row + size_.x;
    return glm::mix(glm::mix(row[0], row[1], part.x), glm::mix(next[0], next[1], part.x), part.y);
  }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.x) + static_cast<std::size_t>(x);
  }
  glm::ivec2 size_;
  std::vector<float> values_;
};

// Number of crossings on the lines through a cell of that side around each point of a lattice, `kFiner` times as fine
// as a picture. The lines through a cube are spread as the sum of three even spreads, along its edges as the map sees
// them. Each is taken at three points, so far apart that the variance of all is that of the cube, side^2 / 12: what
// lattice and picture add by interpolation, pixel^2 / 6 each time, is left out.
constexpr int kFiner = 2;
Lattice throughCells(const DeepOpacityMap& map, float side, glm::vec2 corner, glm::ivec2 size) {
  constexpr float pixel = 1.f / (kFiner * kPixelsPerCell);  // of the lattice [side]
  constexpr float added = pixel * pixel * (1.f / 12.f + 3.f / 6.f + kFiner * kFiner / 6.f);
  const float apart = std::sqrt(1.5f * (1.f / 12.f - added)) * kFiner * kPixelsPerCell;  // [pixel]

  const SummedArea sums(map);
  const float in_map = side * pixel / map.pixelSize();  // pixel of the lattice in those of the map
  Lattice lattice(size);
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const glm::vec2 at = (corner - map.corner()) / map.pixelSize() + in_map * glm::vec2(x, y);
      lattice(x, y) =
          static_cast<float>(sums.over(at - 0.5f * in_map, at + 0.5f * in_map) / (double{in_map} * double{in_map}));
    }
  for (int axis = 0; axis < 3; ++axis) {
    const glm::vec2 edge = apart * glm::vec2(map.axes().right[axis], map.axes().up[axis]);
    Lattice spread(size);
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) {
        const glm::vec2 at(x, y);
        spread(x, y) = std::max(0.f, (lattice.at(at - edge) + lattice.at(at) + lattice.at(at + edge)) / 3.f);
      }
    lattice = std::move(spread);
  }
  return lattice;
}

}  // namespace

TreeDepths::TreeDepths(const CellGrid& grid, const DeepOpacityMap& map, std::span<const float> seen_from)
    : axes_(map.axes()) {
  walkLines(grid, map);
  for (const float seen_side : seen_from) {
    Picture& picture = pictures_.emplace_back();
    if (seen_side == 0.f) continue;
    const float side = std::max(seen_side, kFinestPicture * map.pixelSize());
    const float pixel = side / kPixelsPerCell;  // [m]
    const glm::vec2 covered = map.pixelSize() * glm::vec2(map.size());
    // Half a cell's diagonal is .87 of its side; one more pixel is empty.
    const glm::ivec2 size = glm::ivec2(glm::ceil((covered + 2.f * side) / pixel)) + 2;
    picture.per_pixel = 1.f / pixel;
    picture.corner = map.corner() + 0.5f * (covered - pixel * glm::vec2(size - 1));
    picture.last = glm::vec2(size - 1);
    picture.width = static_cast<std::size_t>(size.x);
    picture.thickness.reserve(picture.width * static_cast<std::size_t>(size.y));
    Lattice lattice = throughCells(map, side, picture.corner, kFiner * (size - 1) + 1);
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x)
        picture.thickness.push_back(fixedDepth(depthSteps(lattice(kFiner * x, kFiner * y))));
  }
  cells_.reserve(grid.active.size());
  Bounds box;
  for (const std::uint32_t cell : grid.active) {
    cells_.emplace_back(map.inMap(grid.centre(cell)));
    box.include(glm::vec3(cells_.back(), 0.f));
  }
  cells_low_ = glm::vec2(box.low);
  cells_high_ = glm::vec2(box.high);
}

void TreeDepths::walkLines(const CellGrid& grid, const DeepOpacityMap& map) {
  struct Sums {
    float length = 0.f, beyond = 0.f, before = 0.f;  // [m], and crossings times [m]
  };
  std::vector<Sums> sums(grid.count());
  const int every = std::max(1, static_cast<int>(grid.cell_size / (kLinesPerCell * map.pixelSize())));
  // The cells may reach beyond the map, whose pixels cover the tree: the lines there meet no leaf.
  Bounds shadow;
  for (int corner = 0; corner < 8; ++corner) {
    const Bounds box = grid.box();
    shadow.include(map.inMap({corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                              corner & 4 ? box.high.z : box.low.z}));
  }
  const float line_step = map.pixelSize() * static_cast<float>(every);
  const glm::ivec2 first(glm::floor((glm::vec2(shadow.low) - map.corner()) / line_step));
  const glm::ivec2 last(glm::ceil((glm::vec2(shadow.high) - map.corner()) / line_step));
  for (int row = first.y; row <= last.y; ++row)
    for (int column = first.x; column <= last.x; ++column) {
      const int x = column * every + every / 2, y = row * every + every / 2;
      const bool in_map = x >= 0 && y >= 0 && x < map.size().x && y < map.size().y;
      const std::span<const Crossing> line = in_map ? map.crossings(x, y) : std::span<const Crossing>{};
      const auto all = static_cast<float>(line.size());
      std::size_t met = 0;
      walk(grid, map.inSpace(x, y, 0.f), axes_.along, [&](std::size_t cell, float begin, float end) {
        Sums& of_cell = sums[cell];
        while (met < line.size() && line[met].depth < begin) ++met;
        float before = static_cast<float>(met) * (end - begin);
        for (; met < line.size() && line[met].depth < end; ++met) before += end - line[met].depth;
        of_cell.length += end - begin;
        of_cell.before += before;
        of_cell.beyond += all * (end - begin) - before;
      });
    }
  beyond_.resize(grid.count());
  before_.resize(grid.count());
  for (std::size_t cell = 0; cell < grid.count(); ++cell) {
    if (sums[cell].length == 0.f) {  // the map's lines are too coarse for it: the nearest to its centre
      const DeepOpacityMap::Counts counts = map.counts(grid.centre(cell));
      beyond_[cell] = fixedDepth(depthSteps(static_cast<float>(counts.beyond)));
      before_[cell] = fixedDepth(depthSteps(static_cast<float>(counts.before)));
      continue;
    }
    const float length = std::max(sums[cell].length, 1e-30f);
    beyond_[cell] = fixedDepth(depthSteps(std::max(sums[cell].beyond, 0.f) / length));
    before_[cell] = fixedDepth(depthSteps(sums[cell].before / length));
  }
}

std::uint32_t TreeDepths::Picture::at(glm::vec2 place) const {
  const glm::vec2 pixel = (place - corner) * per_pixel;
  // Not the opposite: what is not a number lies beside it.
  if (!(pixel.x >= 0.f && pixel.y >= 0.f && pixel.x < last.x && pixel.y < last.y)) return 0;
  const int x = static_cast<int>(pixel.x), y = static_cast<int>(pixel.y);
  const float right = pixel.x - static_cast<float>(x), above = pixel.y - static_cast<float>(y);
  const FixedDepth* const row = &thickness[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)];
  const FixedDepth* const next = row + width;
  const float low = static_cast<float>(row[0]) * (1.f - right) + static_cast<float>(row[1]) * right;
  const float high = static_cast<float>(next[0]) * (1.f - right) + static_cast<float>(next[1]) * right;
  return static_cast<std::uint32_t>(low * (1.f - above) + high * above + 0.5f);
}

TreeDepths::Depths TreeDepths::within(const CellGrid& grid, glm::vec3 point) const {
  const glm::vec3 at = glm::clamp((point - grid.low) / grid.cell_size - 0.5f, glm::vec3(0.f), glm::vec3(grid.size - 1));
  const glm::ivec3 low = glm::min(glm::ivec3(at), grid.size - 1);
  const glm::ivec3 high = glm::min(low + 1, grid.size - 1);
  const glm::vec3 part = at - glm::vec3(low);
  float beyond = 0.f, before = 0.f;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::bvec3 upper(corner & 1, corner & 2, corner & 4);
    const float weight =
        (upper.x ? part.x : 1.f - part.x) * (upper.y ? part.y : 1.f - part.y) * (upper.z ? part.z : 1.f - part.z);
    const std::size_t cell =
        grid.number({upper.x ? high.x : low.x, upper.y ? high.y : low.y, upper.z ? high.z : low.z});
    beyond += weight * static_cast<float>(beyond_[cell]);
    before += weight * static_cast<float>(before_[cell]);
  }
  return {static_cast<std::uint32_t>(beyond + 0.5f), static_cast<std::uint32_t>(before + 0.5f)};
}

// A point outside the tree's box sees it whole, on that side to which the box lies: across any face that parts the two.
// Across a face that the axis runs along, no line through the point meets the box; what a cell around the point sees of
// the tree lies as the box's centre does.
void TreeDepths::addTo(const CellGrid& grid, const TreeDepths& receiver, const CellGrid& receiver_grid,
                       std::size_t receiver_cells, const glm::vec3& displacement, std::int32_t times,
                       std::span<std::int32_t> beyond, std::span<std::int32_t> before) const {
  const glm::vec2 shift(glm::dot(displacement, axes_.right), glm::dot(displacement, axes_.up));
  const Picture& picture = pictures_[receiver_cells];
  const glm::vec2 low = picture.corner + shift, high = low + picture.last / picture.per_pixel;
  if (receiver.cells_low_.x > high.x || receiver.cells_low_.y > high.y || receiver.cells_high_.x < low.x ||
      receiver.cells_high_.y < low.y)
    return;
  // Side of a parting face: 1 where the tree lies along the axis from the points, -1 against it, 0 without such a face.
  const auto side = [&](const glm::vec3& least, const glm::vec3& greatest) {
    bool beside = false;
    for (int axis = 0; axis < 3; ++axis) {
      const bool above = greatest[axis] <= grid.leaves.low[axis] + displacement[axis];
      const bool below = least[axis] >= grid.leaves.high[axis] + displacement[axis];
      if (!above && !below) continue;
      if (std::abs(axes_.along[axis]) > 1e-6f) return above == (axes_.along[axis] > 0.f) ? 1 : -1;
      beside = true;
    }
    if (!beside || least != greatest) return 0;
    return glm::dot(grid.leaves.centre() + displacement - least, axes_.along) > 0.f ? 1 : -1;
  };
  const glm::vec3 half_cell(0.5f * receiver_grid.cell_size);
  const int common_side = side(receiver_grid.box().low + half_cell, receiver_grid.box().high - half_cell);
  for (std::size_t i = 0; i < receiver.cells_.size(); ++i) {
    int cell_side = common_side;
    if (cell_side == 0) {
      const glm::vec3 centre = receiver_grid.centre(receiver_grid.active[i]);
      cell_side = side(centre, centre);
      if (cell_side == 0) {
        const Depths depths = within(grid, centre - displacement);
        beyond[i] += times * static_cast<std::int32_t>(depths.beyond);
        before[i] += times * static_cast<std::int32_t>(depths.before);
        continue;
      }
    }
    const auto all = static_cast<std::int32_t>(picture.at(receiver.cells_[i] - shift));
    (cell_side > 0 ? beyond : before)[i] += times * all;
  }
}

std::size_t TreeDepths::memoryBytes() const {
  std::size_t bytes = (beyond_.size() + before_.size()) * sizeof(FixedDepth) + cells_.size() * sizeof(glm::vec2);
  for (const Picture& picture : pictures_) bytes += picture.thickness.size() * sizeof(FixedDepth);
  return bytes;
}

}  // namespace sunfleck
