#include "field/sun_picture.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "core/bounds.hpp"
#include "core/require.hpp"

namespace sunfleck {
namespace {

constexpr std::size_t kTask = 4096;  // triangles that are worth a task

// A triangle along a row: parts of pixels [begin, end), its depth at the middle of the first [m], how much more it is
// with each further one, and the side that lines come to.
struct RowSpan {
  std::uint32_t begin, end;
  float depth, slope;
  std::uint32_t side;
  float depthAt(std::uint32_t x) const { return depth + static_cast<float>(x - begin) * slope; }
};

// The visible parts of a row's spans, from left to right.
class RowSweep {
 public:
  // Calls show(begin, end, span) where a span is the first of those there.
  template <typename Show>
  void operator()(std::span<const RowSpan> spans, const Show& show) {
    order_.clear();
    for (const RowSpan& span : spans)
      order_.push_back(std::uint64_t{span.begin} << 32 | static_cast<std::uint64_t>(&span - spans.data()));
    std::ranges::sort(order_);
    nearest_ = nullptr;
    behind_.clear();
    for (const std::uint64_t number : order_) {
      const RowSpan& span = spans[static_cast<std::uint32_t>(number)];
      passTo(span.begin, show);
      if (!nearest_) {
        begin(span, span.begin);
      } else if (span.depth < nearest_->depthAt(span.begin)) {
        if (from_ < span.begin) show(from_, span.begin, *nearest_);
        behind_.push_back(nearest_);
        begin(span, span.begin);
      } else {
        behind_.push_back(&span);
        meet(span, span.begin);
      }
    }
    passTo(std::numeric_limits<std::uint32_t>::max(), show);
  }

 private:
  template <typename Show>
  void passTo(std::uint32_t end, const Show& show) {
    while (nearest_ && until_ <= end) {
      show(from_, until_, *nearest_);
      if (next_) {
        *std::ranges::find(behind_, next_) = nearest_;
        begin(*next_, until_);
      } else {
        const std::uint32_t x = until_;
        std::erase_if(behind_, [&](const RowSpan* span) { return span->end <= x; });
        const auto nearest =
            std::ranges::min_element(behind_, {}, [&](const RowSpan* span) { return span->depthAt(x); });
        nearest_ = nullptr;
        if (nearest == behind_.end()) return;
        const RowSpan* const first = *nearest;
        behind_.erase(nearest);
        begin(*first, x);
      }
    }
  }

  void begin(const RowSpan& span, std::uint32_t x) {
    nearest_ = &span;
    next_ = nullptr;
    from_ = x;
    until_ = span.end;
    std::erase_if(behind_, [&](const RowSpan* behind) { return behind->end <= x; });
    for (const RowSpan* const behind : behind_) meet(*behind, x);
  }

  // Whether one behind comes to the front, from x on: leaves and twigs may pass through each other.
  void meet(const RowSpan& behind, std::uint32_t x) {
    const std::uint32_t last = std::min(until_, behind.end) - 1;
    if (last == x || !(behind.depthAt(last) < nearest_->depthAt(last))) return;
    const float parts = (behind.depthAt(x) - nearest_->depthAt(x)) / (nearest_->slope - behind.slope);
    // Not a number where rounding alone tells them apart.
    until_ = x + 1 + (parts > 0.f ? static_cast<std::uint32_t>(std::min(parts, static_cast<float>(last - x - 1))) : 0);
    next_ = &behind;
  }

  const RowSpan* nearest_ = nullptr;
  std::uint32_t from_ = 0, until_ = 0;  // where it is shown
  const RowSpan* next_ = nullptr;       // that comes before it there; none: it ends
  std::vector<const RowSpan*> behind_;  // of those that have begun
  std::vector<std::uint64_t> order_;
};

// The spans of each row, in the order of their triangles.
struct Rows {
  std::vector<std::size_t> first;  // of each row, and one more
  std::vector<RowSpan> spans;
};

Rows rowsOf(const detail::LineGrid& grid) {
  const auto columns = static_cast<std::uint32_t>(grid.size().x);
  const auto rows = static_cast<std::size_t>(grid.size().y);
  struct Task {
    std::vector<std::pair<std::uint32_t, RowSpan>> found;  // row and span
    std::vector<std::uint32_t> next;                       // of each row: how many, then where its next one goes
  };
  std::vector<Task> tasks((grid.triangles() + kTask - 1) / kTask);
  tbb::enumerable_thread_specific<std::vector<detail::Span>> work;
  tbb::parallel_for(std::size_t{0}, tasks.size(), [&](std::size_t number) {
    Task& task = tasks[number];
    task.next.resize(rows);
    grid.forSpans(number * kTask, std::min(grid.triangles(), (number + 1) * kTask), work.local(),
                  [&](const detail::Span& span, std::uint32_t side) {
                    // With a period it may go round, even more than once.
                    for (std::uint32_t done = 0, begin = span.column; done < span.length; begin = 0) {
                      const std::uint32_t length = std::min(span.length - done, columns - begin);
                      const float depth = span.depth + static_cast<float>(done) * span.slope;
                      task.found.emplace_back(span.row, RowSpan{begin, begin + length, depth, span.slope, side});
                      ++task.next[span.row];
                      done += length;
                    }
                  });
  });
  Rows result{.first = std::vector<std::size_t>(rows + 1), .spans = {}};
  for (std::size_t row = 0; row < rows; ++row) {
    std::uint32_t before = 0;
    for (Task& task : tasks) before += std::exchange(task.next[row], before);
    result.first[row + 1] = result.first[row] + before;
  }
  result.spans.resize(result.first[rows]);
  tbb::parallel_for(std::size_t{0}, tasks.size(), [&](std::size_t number) {
    Task& task = tasks[number];
    for (const auto& [row, span] : task.found) result.spans[result.first[row] + task.next[row]++] = span;
  });
  return result;
}

Direction requireGiven(Direction along, bool periodic) {
  require(std::abs(glm::length(along) - 1.f) < 1e-3f, "length of the sunlight's direction", glm::length(along), "1");
  if (periodic) require(along.z < 0.f, "z of the sunlight's direction", along.z, "below 0");
  return along;
}

double pixelAreaFor(const TreeMesh& mesh, const FieldElements& elements, Direction along,
                    const std::optional<glm::vec2>& period, const DirectEffort& effort) {
  const double leaf_area =
      std::accumulate(elements.area.begin(),
                      elements.area.begin() + static_cast<std::ptrdiff_t>(elements.leaf_elements), 0.) /
      static_cast<double>(elements.leaf_elements);
  const glm::dvec3 size(bounds(mesh).size());
  const glm::dvec3 s = glm::abs(glm::dvec3(along));
  const double picture = period ? double{period->x} * double{period->y} * s.z
                                : size.x * size.y * s.z + size.y * size.z * s.x + size.x * size.z * s.y;
  return std::max(leaf_area / double{effort.pixels}, picture / effort.most_pixels);
}

}  // namespace

// (F3)
SunPicture::SunPicture(const TreeMesh& mesh, const FieldElements& elements, const std::optional<glm::vec2>& period,
                       Direction along, const DirectEffort& effort)
    : elements_(&elements),
      along_(requireGiven(along, period.has_value())),
      grid_({&mesh, &elements, period}, along, pixelAreaFor(mesh, elements, along, period, effort), {0.5, 0.5},
            static_cast<int>(kFiner)),
      columns_((static_cast<std::size_t>(grid_.size().x) + kFiner - 1) / kFiner),
      nearest_(columns_ * static_cast<std::size_t>(grid_.size().y)) {
  Rows rows = rowsOf(grid_);
  // Whole numbers, of which the sum is the same in any order.
  std::vector<std::atomic<std::uint64_t>> parts(2 * elements.size());
  tbb::enumerable_thread_specific<RowSweep> sweeps;
  tbb::parallel_for(std::size_t{0}, rows.first.size() - 1, [&](std::size_t row) {
    const auto pixels = std::span(nearest_).subspan(row * columns_, columns_);
    std::ranges::fill(pixels, kNothing);
    sweeps.local()(std::span(rows.spans).subspan(rows.first[row], rows.first[row + 1] - rows.first[row]),
                   [&](std::uint32_t begin, std::uint32_t end, const RowSpan& span) {
                     parts[span.side].fetch_add(end - begin, std::memory_order_relaxed);
                     constexpr std::uint32_t kMiddle = kFiner / 2;
                     for (std::uint32_t i = (begin + kFiner - 1 - kMiddle) / kFiner, x;
                          (x = i * kFiner + kMiddle) < end; ++i)
                       pixels[i] = detail::crossing64(span.depthAt(x), span.side);
                   });
  });
  std::uint64_t shown = 0;
  shown_.reserve(parts.size());
  for (const auto& of_side : parts) {
    shown += of_side.load(std::memory_order_relaxed);
    shown_.push_back(static_cast<double>(of_side.load(std::memory_order_relaxed)) * grid_.lineArea());
  }
  free_ = static_cast<double>(grid_.lines() - shown) * grid_.lineArea();
}

}  // namespace sunfleck
