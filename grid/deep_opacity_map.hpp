#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <span>

#include "core/directions.hpp"
#include "core/tree_mesh.hpp"

namespace sunfleck {

// One place where the line through a pixel's centre crosses a leaf.
struct Crossing {
  float depth;         // distance along the map's direction from the map's origin plane [m]
  std::uint32_t leaf;  // the leaf crossed
};

// (D3) Deep opacity map (Yuksel & Keyser 2008): an orthographic picture of a tree along one direction that keeps, for
// every pixel, all leaf crossings in order, so that depths are exact in count, and the first wood, behind which no
// direct light comes. Immutable after it is made.
class DeepOpacityMap {
 public:
  // Which wood is looked for on each line.
  enum class Wood { none, first, first_and_last };
  // `resolution` >= 1: pixels along the longer side. Pixels are square and cover the leaves and the wood. Without wood
  // half of the work is saved. Works in parallel.
  DeepOpacityMap(const TreeMesh& mesh, Direction along, int resolution, Wood wood = Wood::first);

  Direction along() const { return axes_.along; }
  const Axes& axes() const { return axes_; }
  glm::vec2 corner() const { return corner_; }     // (right, up) coordinates of pixel (0, 0)'s outer corner [m]
  float pixelSize() const { return pixel_size_; }  // side of a pixel [m]
  glm::ivec2 size() const { return size_; }        // [pixel]

  // All crossings, pixel by pixel, sorted by depth: those of pixel (x, y) are [first[i], first[i + 1]), i = y * width +
  // x.
  std::span<const std::uint32_t> first() const { return {first_.get(), pixelNumber(0, size_.y) + 1}; }
  std::span<const Crossing> crossings() const { return {crossings_.get(), first().back()}; }
  std::span<const Crossing> crossings(int x, int y) const;
  // Depth of the first wood in each pixel [m]; infinity where there is none; empty in a map made without wood.
  std::span<const float> woodDepth() const { return {wood_depth_.get(), wood_depth_ ? pixelNumber(0, size_.y) : 0}; }
  // Depth of the last wood in each pixel [m]; -infinity where there is none; empty unless asked for.
  std::span<const float> lastWoodDepth() const {
    return {last_wood_depth_.get(), last_wood_depth_ ? pixelNumber(0, size_.y) : 0};
  }

  // (right, up, depth) of a point in the map [m].
  glm::vec3 inMap(glm::vec3 point) const;
  // The point at the centre of a pixel and a depth.
  glm::vec3 inSpace(int x, int y, float depth) const;

  // Leaf crossings on the line through the pixel that `point` falls in: n+, between the light and the point, and n-,
  // beyond it. Leaf `own` is not counted. Points beside the map meet no leaf.
  static constexpr std::uint32_t kNoLeaf = ~0u;
  struct Counts {
    int before = 0;  // n+
    int beyond = 0;  // n-
  };
  Counts counts(glm::vec3 point, std::uint32_t own = kNoLeaf) const;

 private:
  std::size_t pixelNumber(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.x) + static_cast<std::size_t>(x);
  }

  Axes axes_;
  glm::vec2 corner_{0.f};
  float pixel_size_ = 0.f;
  glm::ivec2 size_{0};
  std::unique_ptr<std::uint32_t[]> first_;
  std::unique_ptr<Crossing[]> crossings_;
  std::unique_ptr<float[]> wood_depth_, last_wood_depth_;
};

}  // namespace sunfleck
