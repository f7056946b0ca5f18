#include "grid/tree_depths.hpp"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "grid/detail/part_sums.hpp"

namespace sunfleck {
namespace {

// At most so many of the map's lines to a cell's side are walked. Depths are off by their sampling alone: by 2.7 %
// (RMS, the cherry) with 8 lines to a side, 1.0 % with 16, 0.5 % with 32.
constexpr int kLinesPerCell = 16;
constexpr float kFinestPicture = 2.f;  // as seen from cells so many of the map's pixels wide or narrower
constexpr int kPixelsPerCell = 8;      // of a picture of thickness, to a cell's side
constexpr int kParts = 2;              // of a cell's side, that depths within the crown are told apart in
constexpr int kMargin = 1;             // cells around the tree's in which they are told too

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
constexpr int kFiner = 1;
constexpr int kTaps = 3;
Lattice throughCells(const DeepOpacityMap& map, float side, glm::vec2 corner, glm::ivec2 size) {
  constexpr float pixel = 1.f / (kFiner * kPixelsPerCell);  // of the lattice [side]
  constexpr float added = pixel * pixel * (1.f / 12.f + 3.f / 6.f + kFiner * kFiner / 6.f);
  // Of kTaps points each 1 apart the variance is (kTaps^2 - 1) / 12.
  const float apart = std::sqrt((1.f - 12.f * added) / (kTaps * kTaps - 1.f)) * kFiner * kPixelsPerCell;  // [pixel]

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
        float sum = lattice.at(at);
        for (int tap = 1; tap <= kTaps / 2; ++tap) {
          const glm::vec2 away = static_cast<float>(tap) * edge;
          sum += lattice.at(at - away) + lattice.at(at + away);
        }
        spread(x, y) = std::max(0.f, sum / kTaps);
      }
    lattice = std::move(spread);
  }
  return lattice;
}

}  // namespace

TreeDepths::TreeDepths(const CellGrid& grid, const DeepOpacityMap& map, std::span<const float> seen_from)
    : axes_(map.axes()) {
  pictures_.resize(seen_from.size());
  within_.resize(seen_from.size());
  const auto inside = [&] {
    const std::vector<Means> means = walkLines(grid, map);
    for (std::size_t i = 0; i < seen_from.size(); ++i)
      if (seen_from[i] > 0.f) within_[i] = overCells(means, seen_from[i]);
  };
  const auto outside = [&] {
    for (std::size_t i = 0; i < seen_from.size(); ++i)
      if (seen_from[i] > 0.f) pictures_[i] = pictureOf(map, seen_from[i]);
  };
  tbb::parallel_invoke(inside, outside);
  cells_.reserve(grid.active.size());
  Bounds box;
  for (const std::uint32_t cell : grid.active) {
    cells_.emplace_back(map.inMap(grid.centre(cell)));
    box.include(glm::vec3(cells_.back(), 0.f));
  }
  cells_low_ = glm::vec2(box.low);
  cells_high_ = glm::vec2(box.high);
}

TreeDepths::Picture TreeDepths::pictureOf(const DeepOpacityMap& map, float seen_side) {
  const float side = std::max(seen_side, kFinestPicture * map.pixelSize());
  const float pixel = side / kPixelsPerCell;  // [m]
  const glm::vec2 covered = map.pixelSize() * glm::vec2(map.size());
  // Half a cell's diagonal is .87 of its side; one more pixel is empty.
  const glm::ivec2 size = glm::ivec2(glm::ceil((covered + 2.f * side) / pixel)) + 2;
  Picture picture{.corner = map.corner() + 0.5f * (covered - pixel * glm::vec2(size - 1)),
                  .per_pixel = 1.f / pixel,
                  .last = glm::vec2(size - 1),
                  .width = static_cast<std::size_t>(size.x)};
  picture.thickness.reserve(picture.width * static_cast<std::size_t>(size.y));
  Lattice lattice = throughCells(map, side, picture.corner, kFiner * (size - 1) + 1);
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x)
      picture.thickness.push_back(fixedDepth(depthSteps(lattice(kFiner * x, kFiner * y))));
  return picture;
}

// Means over parts of cells.
std::vector<TreeDepths::Means> TreeDepths::walkLines(const CellGrid& grid, const DeepOpacityMap& map) {
  parts_.cell_size = grid.cell_size / kParts;
  parts_.low = grid.low - static_cast<float>(kMargin) * grid.cell_size;
  parts_.size = kParts * (grid.size + 2 * kMargin);
  const int every = std::max(1, static_cast<int>(grid.cell_size / (kLinesPerCell * map.pixelSize())));
  const std::vector<detail::PartSums> sums = detail::sumsOverParts(parts_, map, every);
  const auto mean = [&](const detail::PartSums& of, const CellGrid& of_grid, std::size_t number) {
    if (of.length > 0.f) return Means{std::max(of.beyond, 0.f) / of.length, of.before / of.length};
    // The map's lines are too coarse for it: the nearest to its centre.
    const DeepOpacityMap::Counts counts = map.counts(of_grid.centre(number));
    return Means{static_cast<float>(counts.beyond), static_cast<float>(counts.before)};
  };
  const bool with_wood = !map.lastWoodDepth().empty();
  for (std::size_t cell = 0; cell < grid.count(); ++cell) {
    detail::PartSums of_cell;
    const glm::ivec3 first_part = kParts * (grid.cell(cell) + kMargin);
    for (int i = 0; i < kParts * kParts * kParts; ++i)
      of_cell += sums[parts_.number(first_part + glm::ivec3(i % kParts, i / kParts % kParts, i / (kParts * kParts)))];
    const Means of = mean(of_cell, grid, cell);
    beyond_.push_back(fixedDepth(depthSteps(of.beyond)));
    before_.push_back(fixedDepth(depthSteps(of.before)));
    if (!with_wood) continue;
    const auto open = [&](float shaded) {
      return of_cell.length > 0.f ? std::clamp(1.f - shaded / of_cell.length, 0.f, 1.f) : 1.f;
    };
    open_beyond_.push_back(open(of_cell.before_last_wood));
    open_before_.push_back(open(of_cell.behind_first_wood));
  }
  std::vector<Means> means;
  means.reserve(sums.size());
  for (std::size_t part = 0; part < sums.size(); ++part) means.push_back(mean(sums[part], parts_, part));
  return means;
}

// Means over cells of side `seen_side` around the centres of parts, from the means over parts: along each axis, of the
// parts as far away as `whole` with weight 1 and of the next ones with weight `rim`, so that the variance of all is
// that of the cell, less 1/6 that interpolation between parts adds.
std::vector<TreeDepths::Depths> TreeDepths::overCells(std::vector<Means> means, float seen_side) const {
  const float side = seen_side / parts_.cell_size;
  const float wanted = side * side / 12.f - 1.f / 6.f - 1.f / 12.f;  // besides a part's own [squared side of a part]
  int whole = 0;
  float sum = 0.f;  // of squared distances of whole parts
  const auto next = [&] { return static_cast<float>((whole + 1) * (whole + 1)); };
  const auto parts = [&] { return static_cast<float>(2 * whole + 1); };
  const int farthest = std::max({parts_.size.x, parts_.size.y, parts_.size.z});  // there all weigh alike already
  while (whole < farthest && sum + 2.f * next() <= wanted * (parts() + 2.f)) {
    sum += 2.f * next();
    ++whole;
  }
  const float rim = whole == farthest ? 0.f : std::max(0.f, (wanted * parts() - sum) / (2.f * (next() - wanted)));
  const float weight = 1.f / (parts() + 2.f * rim);
  const std::array<std::size_t, 3> strides{1, parts_.number({0, 1, 0}), parts_.number({0, 0, 1})};
  std::vector<Means> line;
  for (int axis = 0; axis < 3 && (whole > 0 || rim > 0.f); ++axis) {
    const std::size_t stride = strides[static_cast<std::size_t>(axis)];
    const int count = parts_.size[axis], across = parts_.size[(axis + 1) % 3], up = parts_.size[(axis + 2) % 3];
    line.resize(static_cast<std::size_t>(count));
    for (int row = 0; row < across * up; ++row) {
      glm::ivec3 first(0);
      first[(axis + 1) % 3] = row % across;
      first[(axis + 2) % 3] = row / across;
      Means* const of_row = &means[parts_.number(first)];
      for (int i = 0; i < count; ++i) line[static_cast<std::size_t>(i)] = of_row[static_cast<std::size_t>(i) * stride];
      const auto at = [&](int i) { return line[static_cast<std::size_t>(std::clamp(i, 0, count - 1))]; };
      for (int i = 0; i < count; ++i) {
        Means total{rim * (at(i - whole - 1).beyond + at(i + whole + 1).beyond),
                    rim * (at(i - whole - 1).before + at(i + whole + 1).before)};
        for (int k = -whole; k <= whole; ++k) {
          total.beyond += at(i + k).beyond;
          total.before += at(i + k).before;
        }
        of_row[static_cast<std::size_t>(i) * stride] = {weight * total.beyond, weight * total.before};
      }
    }
  }
  std::vector<Depths> depths;
  depths.reserve(means.size());
  for (const Means& of : means)
    depths.push_back({fixedDepth(depthSteps(of.beyond)), fixedDepth(depthSteps(of.before))});
  return depths;
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

TreeDepths::Depths TreeDepths::within(std::size_t receiver_cells, glm::vec3 point) const {
  const std::vector<Depths>& depths = within_[receiver_cells];
  const glm::vec3 at =
      glm::clamp((point - parts_.low) / parts_.cell_size - 0.5f, glm::vec3(0.f), glm::vec3(parts_.size - 1));
  const glm::ivec3 low = glm::min(glm::ivec3(at), parts_.size - 2);
  const glm::vec3 share = at - glm::vec3(low);
  const std::size_t first = parts_.number(low), up = parts_.number({0, 1, 0}), above = parts_.number({0, 0, 1});
  float beyond = 0.f, before = 0.f;
  for (const std::size_t z : {0u, 1u})
    for (const std::size_t y : {0u, 1u}) {
      const Depths* const row = &depths[first + y * up + z * above];
      const float weight = (y ? share.y : 1.f - share.y) * (z ? share.z : 1.f - share.z);
      beyond += weight * glm::mix(static_cast<float>(row[0].beyond), static_cast<float>(row[1].beyond), share.x);
      before += weight * glm::mix(static_cast<float>(row[0].before), static_cast<float>(row[1].before), share.x);
    }
  return {static_cast<FixedDepth>(beyond + 0.5f), static_cast<FixedDepth>(before + 0.5f)};
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
  // Side of a face that parts the box of a cell, or of all, from the tree: 1 where the tree lies along the axis from
  // it, -1 against it, 0 without such a face.
  const auto side = [&](const Bounds& box, bool one_cell) {
    bool beside = false;
    for (int axis = 0; axis < 3; ++axis) {
      const bool above = box.high[axis] <= grid.leaves.low[axis] + displacement[axis];
      const bool below = box.low[axis] >= grid.leaves.high[axis] + displacement[axis];
      if (!above && !below) continue;
      if (std::abs(axes_.along[axis]) > 1e-6f) return above == (axes_.along[axis] > 0.f) ? 1 : -1;
      beside = true;
    }
    if (!beside || !one_cell) return 0;
    return glm::dot(grid.leaves.centre() + displacement - box.centre(), axes_.along) > 0.f ? 1 : -1;
  };
  // A cell is whole where depths within the crown reach as far.
  const glm::vec3 half_cell(std::min(0.5f * receiver_grid.cell_size, kMargin * grid.cell_size));
  const glm::vec3 beyond_centre = half_cell - 0.5f * receiver_grid.cell_size;
  const int common_side =
      side({receiver_grid.box().low - beyond_centre, receiver_grid.box().high + beyond_centre}, false);
  for (std::size_t i = 0; i < receiver.cells_.size(); ++i) {
    int cell_side = common_side;
    if (cell_side == 0) {
      const glm::vec3 centre = receiver_grid.centre(receiver_grid.active[i]);
      cell_side = side({centre - half_cell, centre + half_cell}, true);
      if (cell_side == 0) {
        const Depths depths = within(receiver_cells, centre - displacement);
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
  std::size_t bytes = (beyond_.size() + before_.size()) * sizeof(FixedDepth) + cells_.size() * sizeof(glm::vec2) +
                      (open_beyond_.size() + open_before_.size()) * sizeof(float);
  for (const Picture& picture : pictures_) bytes += picture.thickness.size() * sizeof(FixedDepth);
  for (const std::vector<Depths>& depths : within_) bytes += depths.size() * sizeof(Depths);
  return bytes;
}

}  // namespace sunfleck
