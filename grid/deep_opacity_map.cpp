#include "grid/deep_opacity_map.hpp"

#include <tbb/blocked_range.h>
#include <tbb/concurrent_queue.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <glm/geometric.hpp>
#include <limits>
#include <string>
#include <vector>

#include "core/available_memory.hpp"
#include "core/require.hpp"
#include "grid/detail/scan_conversion.hpp"

namespace sunfleck {
namespace {

using Range = tbb::blocked_range<std::size_t>;
constexpr std::size_t kTask = 4096;  // triangles or vertices that are worth a task
constexpr std::size_t kBands = 32;   // of rows of pixels, each worth a task

// Box of some triangles, given the positions of their corners.
Bounds boxOf(const std::vector<glm::uvec3>& triangles, const glm::vec3* positions) {
  return tbb::parallel_reduce(
      Range(0, triangles.size(), kTask), Bounds{},
      [&](const Range& range, Bounds box) {
        for (std::size_t i = range.begin(); i != range.end(); ++i)
          for (int corner = 0; corner < 3; ++corner) box.include(positions[triangles[i][corner]]);
        return box;
      },
      [](Bounds box, const Bounds& other) {
        box.include(other);
        return box;
      });
}

// What a thread found in a band.
struct Found {
  std::vector<detail::Span> leaves, wood;  // of triangles, and of no further interest which
  std::uint64_t crossings = 0;             // of leaves
};

using Rank = std::uint64_t;  // see rankOf

// Memory in which maps are made. It is kept for the next map, since what the system gives anew it clears page by page,
// which would take as long as the work.
struct Workspace {
  struct OfThread {
    std::array<Found, kBands> found;
    std::vector<std::uint32_t> next;  // of each pixel of a band, where the next crossing goes
    std::vector<Rank> crossings;      // of a band
    std::vector<detail::Span> spans;  // of some triangles
  };
  std::vector<glm::vec3> projected;  // of the vertices, (right, up, depth) [m]
  tbb::enumerable_thread_specific<OfThread> threads;
};

// A workspace lent to a map.
class LentWorkspace {
 public:
  LentWorkspace() {
    if (!idle_.try_pop(lent_)) lent_ = std::make_unique<Workspace>();
  }
  ~LentWorkspace() {
    if (idle_.unsafe_size() < kKept) idle_.push(std::move(lent_));
  }
  LentWorkspace(const LentWorkspace&) = delete;
  LentWorkspace& operator=(const LentWorkspace&) = delete;
  Workspace& operator*() { return *lent_; }

 private:
  static constexpr int kKept = 4;  // more are rarely lent at once
  static inline tbb::concurrent_queue<std::unique_ptr<Workspace>> idle_;
  std::unique_ptr<Workspace> lent_;
};

glm::vec3 projectedTo(const Axes& axes, const glm::vec3& point) {
  return {glm::dot(point, axes.right), glm::dot(point, axes.up), glm::dot(point, axes.along)};
}

// Leaves the vertices' (right, up, depth) in `projected`.
OpacityMapFrame frameOf(const TreeMesh& mesh, Direction along, int resolution, std::vector<glm::vec3>& projected) {
  assert(resolution >= 1);
  OpacityMapFrame frame{.axes = axesAlong(along)};
  projected.resize(mesh.vertices.size());
  tbb::parallel_for(Range(0, mesh.vertices.size(), kTask), [&](const Range& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) projected[i] = projectedTo(frame.axes, mesh.vertices[i]);
  });
  Bounds box = boxOf(mesh.leaf_triangles, projected.data());
  box.include(boxOf(mesh.wood_triangles, projected.data()));
  const glm::vec2 extent = box.size();
  frame.pixel_size = std::max({extent.x, extent.y, 1e-6f}) / static_cast<float>(resolution);
  frame.size = glm::clamp(glm::ivec2(glm::ceil(extent / frame.pixel_size)), 1, resolution);
  frame.corner = glm::vec2(box.centre()) - 0.5f * frame.pixel_size * glm::vec2(frame.size);
  return frame;
}

// A crossing as a number that is greater the deeper it lies, and of equal ones the one with the greater leaf.
constexpr std::uint32_t kSign = 1u << 31;

Rank rankOf(const Crossing& crossing) {
  const auto bits = std::bit_cast<std::uint32_t>(crossing.depth);
  return Rank{bits & kSign ? ~bits : bits | kSign} << 32 | crossing.leaf;
}
Crossing crossingOf(Rank rank) {
  const auto bits = static_cast<std::uint32_t>(rank >> 32);
  return {std::bit_cast<float>(bits & kSign ? bits ^ kSign : ~bits), static_cast<std::uint32_t>(rank)};
}

// Writes the crossings of a line by depth. Most lines have a few, in which each finds its place by counting those
// before it: without branches, as no processor foresees them.
void sortByDepth(std::span<Rank> line, Crossing* sorted) {
  constexpr std::size_t kFew = 16;
  if (line.size() > kFew) {
    std::sort(line.begin(), line.end());
    for (const Rank rank : line) *sorted++ = crossingOf(rank);
    return;
  }
  std::array<std::uint32_t, kFew> place{};
  for (std::size_t i = 1; i < line.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const bool swap = line[i] < line[j];
      place[i] += !swap;
      place[j] += swap;
    }
  for (std::size_t i = 0; i < line.size(); ++i) sorted[place[i]] = crossingOf(line[i]);
}

}  // namespace

OpacityMapFrame opacityMapFrame(const TreeMesh& mesh, Direction along, int resolution) {
  LentWorkspace lent;
  return frameOf(mesh, along, resolution, (*lent).projected);
}

DeepOpacityMap::DeepOpacityMap(const OpacityMapFrame& frame, Arrays arrays)
    : frame_(frame), arrays_(std::move(arrays)) {}

DeepOpacityMap::DeepOpacityMap(const TreeMesh& mesh, Direction along, int resolution, Wood wood) {
  const bool with_wood = wood != Wood::none;
  LentWorkspace lent;
  Workspace& workspace = *lent;
  const auto& projected = workspace.projected;
  frame_ = frameOf(mesh, along, resolution, workspace.projected);
  const glm::ivec2 size = frame_.size;
  const detail::PixelGrid pixel_grid{
      .corner = frame_.corner, .pixels_per_metre = 1. / double{frame_.pixel_size}, .columns = size.x, .rows = size.y};
  int band_rows_log2 = 0;  // each band has a power of two of rows
  while ((size.y - 1) >> band_rows_log2 >= int{kBands}) ++band_rows_log2;
  for (auto& of_thread : workspace.threads)
    for (Found& band : of_thread.found) {
      band.leaves.clear();
      band.wood.clear();
      band.crossings = 0;
    }
  const detail::ScanConversion scan = detail::scanConversion();
  const std::size_t room = std::max(kTask, static_cast<std::size_t>(size.y));
  const auto find = [&](const std::vector<glm::uvec3>& triangles, const auto& put) {
    tbb::parallel_for(Range(0, triangles.size(), kTask), [&](const Range& range) {
      Workspace::OfThread& work = workspace.threads.local();
      work.spans.resize(room);
      for (std::size_t i = range.begin(); i != range.end();) {
        const detail::Scanned scanned =
            scan(pixel_grid, projected.data(), &triangles[i], range.end() - i, work.spans.data(), room);
        for (const detail::Span& span : std::span(work.spans).first(scanned.spans))
          put(work.found[span.row >> band_rows_log2], span, i + span.triangle);
        i += scanned.triangles;
      }
    });
  };
  find(mesh.leaf_triangles, [&](Found& band, detail::Span span, std::size_t triangle) {
    span.triangle = mesh.leaf_of_triangle[triangle];
    band.leaves.push_back(span);
    band.crossings += span.length;
  });
  if (with_wood)
    find(mesh.wood_triangles, [](Found& band, const detail::Span& span, std::size_t) { band.wood.push_back(span); });

  // Who found something, told before others join in.
  std::vector<const Workspace::OfThread*> finders;
  for (const auto& of_thread : workspace.threads) finders.push_back(&of_thread);
  std::array<std::uint64_t, kBands + 1> counted{};
  for (std::size_t band = 0; band < kBands; ++band) {
    counted[band + 1] = counted[band];
    for (const auto* of_thread : finders) counted[band + 1] += of_thread->found[band].crossings;
  }
  require(counted.back() <= std::numeric_limits<std::uint32_t>::max(), "leaf crossings on the lines of an opacity map",
          counted.back(), "below 2^32: of fewer pixels");
  // Each is held twice for a while. Few are not worth asking the system.
  if (const double bytes = 16. * static_cast<double>(counted.back()); bytes > 1e9)
    require(bytes <= availableMemory(), "memory for the leaf crossings on the lines of an opacity map [byte]", bytes,
            "at most what there is, " + std::to_string(static_cast<std::uint64_t>(availableMemory())) +
                ": of fewer leaves one above the other, or of fewer pixels");
  std::array<std::uint32_t, kBands + 1> band_first{};
  std::copy(counted.begin(), counted.end(), band_first.begin());
  const std::size_t pixels = pixelNumber(0, size.y);
  arrays_.first = std::make_unique_for_overwrite<std::uint32_t[]>(pixels + 1);
  arrays_.first[pixels] = band_first.back();
  arrays_.crossings = std::make_unique_for_overwrite<Crossing[]>(band_first.back());
  if (with_wood) arrays_.wood_depth = std::make_unique_for_overwrite<float[]>(pixels);
  if (wood == Wood::first_and_last) arrays_.last_wood_depth = std::make_unique_for_overwrite<float[]>(pixels);
  const auto firstPixel = [&](const detail::Span& span) {
    return pixelNumber(static_cast<int>(span.column), static_cast<int>(span.row));
  };
  tbb::parallel_for(std::size_t{0}, kBands, [&](std::size_t band) {
    const auto rowsBefore = [&](std::size_t bands) {
      return std::min(size.y, static_cast<int>(bands) << band_rows_log2);
    };
    const std::size_t begin = pixelNumber(0, rowsBefore(band)), end = pixelNumber(0, rowsBefore(band + 1));
    Workspace::OfThread& work = workspace.threads.local();
    auto& next = work.next;
    next.assign(end - begin + 1, 0u);
    work.crossings.resize(band_first[band + 1] - band_first[band]);
    for (const auto* of_thread : finders)
      for (const detail::Span& span : of_thread->found[band].leaves) {
        const std::size_t pixel = firstPixel(span) - begin;
        ++next[pixel];
        --next[pixel + span.length];
      }
    std::uint32_t sum = 0, met = 0;
    for (std::size_t pixel = 0; pixel < end - begin; ++pixel) {
      met += next[pixel];
      next[pixel] = sum;
      sum += met;
    }
    for (const auto* of_thread : finders)
      for (const detail::Span& span : of_thread->found[band].leaves) {
        std::uint32_t* const next_of_pixel = &next[firstPixel(span) - begin];
        for (std::uint32_t i = 0; i < span.length; ++i)
          work.crossings[next_of_pixel[i]++] = rankOf({span.depth + static_cast<float>(i) * span.slope, span.triangle});
      }
    std::uint32_t first = 0;
    for (std::size_t pixel = begin; pixel < end; ++pixel) {
      const std::uint32_t of_pixel = next[pixel - begin] - first;
      arrays_.first[pixel] = band_first[band] + first;
      if (of_pixel)
        sortByDepth(std::span(work.crossings).subspan(first, of_pixel), &arrays_.crossings[arrays_.first[pixel]]);
      first += of_pixel;
    }
    if (!with_wood) return;
    for (std::size_t pixel = begin; pixel < end; ++pixel)
      arrays_.wood_depth[pixel] = std::numeric_limits<float>::infinity();
    for (const auto* of_thread : finders)
      for (const detail::Span& span : of_thread->found[band].wood) {
        float* const depth = &arrays_.wood_depth[firstPixel(span)];
        for (std::uint32_t i = 0; i < span.length; ++i)
          depth[i] = std::min(depth[i], span.depth + static_cast<float>(i) * span.slope);
      }
    if (wood != Wood::first_and_last) return;
    for (std::size_t pixel = begin; pixel < end; ++pixel)
      arrays_.last_wood_depth[pixel] = -std::numeric_limits<float>::infinity();
    for (const auto* of_thread : finders)
      for (const detail::Span& span : of_thread->found[band].wood) {
        float* const depth = &arrays_.last_wood_depth[firstPixel(span)];
        for (std::uint32_t i = 0; i < span.length; ++i)
          depth[i] = std::max(depth[i], span.depth + static_cast<float>(i) * span.slope);
      }
  });
}

std::span<const Crossing> DeepOpacityMap::crossings(int x, int y) const {
  const std::size_t pixel = pixelNumber(x, y);
  return crossings().subspan(arrays_.first[pixel], arrays_.first[pixel + 1] - arrays_.first[pixel]);
}

glm::vec3 DeepOpacityMap::inMap(glm::vec3 point) const {
  return projectedTo(frame_.axes, point);
}

glm::vec3 DeepOpacityMap::inSpace(int x, int y, float depth) const {
  const glm::vec2 at =
      frame_.corner + frame_.pixel_size * (glm::vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5f);
  return at.x * frame_.axes.right + at.y * frame_.axes.up + depth * frame_.axes.along;
}

DeepOpacityMap::Counts DeepOpacityMap::counts(glm::vec3 point, std::uint32_t own) const {
  const glm::vec3 at = inMap(point);
  const glm::vec2 pixel = (glm::vec2(at) - frame_.corner) / frame_.pixel_size;
  if (!(pixel.x >= 0.f && pixel.y >= 0.f && pixel.x < static_cast<float>(frame_.size.x) &&
        pixel.y < static_cast<float>(frame_.size.y)))
    return {};
  const std::span<const Crossing> line = crossings(static_cast<int>(pixel.x), static_cast<int>(pixel.y));
  const auto beyond =
      std::partition_point(line.begin(), line.end(), [&](const Crossing& crossing) { return crossing.depth < at.z; });
  Counts counts{.before = static_cast<int>(beyond - line.begin()), .beyond = static_cast<int>(line.end() - beyond)};
  if (own != kNoLeaf)
    for (const Crossing& crossing : line)
      if (crossing.leaf == own) --(crossing.depth < at.z ? counts.before : counts.beyond);
  return counts;
}

}  // namespace sunfleck
