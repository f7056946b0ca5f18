#include "grid/deep_opacity_map.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <glm/geometric.hpp>
#include <limits>

#include "grid/detail/scan_conversion.hpp"

namespace sunfleck {
namespace {

using Range = tbb::blocked_range<std::size_t>;
constexpr std::size_t kTask = 4096;  // triangles or vertices that are worth a task
constexpr std::size_t kBands = 16;   // of rows of pixels, each worth a task

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

// Where a triangle meets the line of a pixel.
struct Fragment {
  std::uint32_t pixel;
  Crossing crossing;
};

// What one task found in a band.
struct Found {
  std::vector<Fragment> leaves, wood;
};

bool before(const Crossing& a, const Crossing& b) {
  return (a.depth < b.depth) | ((a.depth == b.depth) & (a.leaf < b.leaf));
}

// Sorts the crossings of a line by depth. Most lines have a few, in which each finds its place by counting those before
// it: without branches, as no processor foresees them.
void sortByDepth(std::span<Crossing> line) {
  constexpr std::size_t kFew = 16;
  if (line.size() > kFew) return std::sort(line.begin(), line.end(), before);
  std::array<std::size_t, kFew> place{};
  for (std::size_t i = 1; i < line.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const bool swap = before(line[i], line[j]);
      place[i] += !swap;
      place[j] += swap;
    }
  std::array<Crossing, kFew> unsorted;
  std::copy(line.begin(), line.end(), unsorted.begin());
  for (std::size_t i = 0; i < line.size(); ++i) line[place[i]] = unsorted[i];
}

}  // namespace

DeepOpacityMap::DeepOpacityMap(const TreeMesh& mesh, Direction along, int resolution, bool with_wood)
    : axes_(axesAlong(along)) {
  assert(resolution >= 1);
  const auto projected = std::make_unique_for_overwrite<glm::vec3[]>(mesh.vertices.size());
  tbb::parallel_for(Range(0, mesh.vertices.size(), kTask), [&](const Range& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) projected[i] = inMap(mesh.vertices[i]);
  });
  Bounds box = boxOf(mesh.leaf_triangles, projected.get());
  box.include(boxOf(mesh.wood_triangles, projected.get()));
  const glm::vec2 extent = box.size();
  pixel_size_ = std::max({extent.x, extent.y, 1e-6f}) / static_cast<float>(resolution);
  size_ = glm::clamp(glm::ivec2(glm::ceil(extent / pixel_size_)), 1, resolution);
  corner_ = glm::vec2(box.centre()) - 0.5f * pixel_size_ * glm::vec2(size_);

  const double pixels_per_metre = 1. / double{pixel_size_};
  const auto inPixels = [&](std::uint32_t vertex) {
    const glm::dvec3 at = projected[vertex];
    return glm::dvec3((glm::dvec2(at) - glm::dvec2(corner_)) * pixels_per_metre + 0.5, at.z);
  };
  const int band_rows = (size_.y + int{kBands} - 1) / int{kBands};
  const std::size_t leaves = mesh.leaf_triangles.size();
  const std::size_t triangles = leaves + (with_wood ? mesh.wood_triangles.size() : 0);
  std::vector<std::array<Found, kBands>> found((triangles + kTask - 1) / kTask);  // tasks share nothing
  tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t task) {
    const auto find = [&](const glm::uvec3& t, std::vector<Fragment> Found::*kind, std::uint32_t leaf) {
      detail::scanTriangle({inPixels(t.x), inPixels(t.y), inPixels(t.z)}, size_,
                           [&](int y, int x_first, int x_end, const auto& depth) {
                             auto& fragments = found[task][static_cast<std::size_t>(y / band_rows)].*kind;
                             auto pixel = static_cast<std::uint32_t>(pixelNumber(x_first, y));
                             for (int x = x_first; x < x_end; ++x)
                               fragments.push_back({pixel++, {static_cast<float>(depth(x)), leaf}});
                           });
    };
    const std::size_t end = std::min(triangles, (task + 1) * kTask);
    std::size_t i = task * kTask;
    for (; i < std::min(leaves, end); ++i) find(mesh.leaf_triangles[i], &Found::leaves, mesh.leaf_of_triangle[i]);
    for (; i < end; ++i) find(mesh.wood_triangles[i - leaves], &Found::wood, kNoLeaf);
  });

  std::array<std::uint32_t, kBands + 1> band_first{};
  for (std::size_t band = 0; band < kBands; ++band) {
    band_first[band + 1] = band_first[band];
    for (const auto& of_task : found) band_first[band + 1] += static_cast<std::uint32_t>(of_task[band].leaves.size());
  }
  const std::size_t pixels = pixelNumber(0, size_.y);
  first_.assign(pixels + 1, 0u);
  first_.back() = band_first.back();
  crossings_ = std::make_unique_for_overwrite<Crossing[]>(first_.back());
  if (with_wood) wood_depth_.assign(pixels, std::numeric_limits<float>::infinity());
  tbb::parallel_for(std::size_t{0}, kBands, [&](std::size_t band) {
    const auto rowsBefore = [&](std::size_t bands) { return std::min(size_.y, static_cast<int>(bands) * band_rows); };
    const std::size_t begin = pixelNumber(0, rowsBefore(band)), end = pixelNumber(0, rowsBefore(band + 1));
    for (const auto& of_task : found)
      for (const Fragment& fragment : of_task[band].leaves) ++first_[fragment.pixel];
    std::uint32_t sum = band_first[band];
    for (std::size_t pixel = begin; pixel < end; ++pixel) first_[pixel] = sum += first_[pixel];
    for (const auto& of_task : found)
      for (const Fragment& fragment : of_task[band].leaves) crossings_[--first_[fragment.pixel]] = fragment.crossing;
    for (std::size_t pixel = begin; pixel < end; ++pixel) {
      const std::uint32_t next = pixel + 1 < end ? first_[pixel + 1] : band_first[band + 1];
      sortByDepth({&crossings_[first_[pixel]], next - first_[pixel]});
    }
    for (const auto& of_task : found)
      for (const Fragment& fragment : of_task[band].wood)
        wood_depth_[fragment.pixel] = std::min(wood_depth_[fragment.pixel], fragment.crossing.depth);
  });
}

std::span<const Crossing> DeepOpacityMap::crossings(int x, int y) const {
  const std::size_t pixel = pixelNumber(x, y);
  return crossings().subspan(first_[pixel], first_[pixel + 1] - first_[pixel]);
}

glm::vec3 DeepOpacityMap::inMap(glm::vec3 point) const {
  return {glm::dot(point, axes_.right), glm::dot(point, axes_.up), glm::dot(point, axes_.along)};
}

glm::vec3 DeepOpacityMap::inSpace(int x, int y, float depth) const {
  const glm::vec2 at = corner_ + pixel_size_ * (glm::vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5f);
  return at.x * axes_.right + at.y * axes_.up + depth * axes_.along;
}

DeepOpacityMap::Counts DeepOpacityMap::counts(glm::vec3 point, std::uint32_t own) const {
  const glm::vec3 at = inMap(point);
  const glm::vec2 pixel = (glm::vec2(at) - corner_) / pixel_size_;
  if (!(pixel.x >= 0.f && pixel.y >= 0.f && pixel.x < static_cast<float>(size_.x) &&
        pixel.y < static_cast<float>(size_.y)))
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
