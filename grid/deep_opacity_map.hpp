#pragma once

#include <cstdint>
#include <functional>
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

// Where the pixels of a map lie: square ones that cover the leaves and the wood of a tree.
struct OpacityMapFrame {
  Axes axes;               // `along`: the map's direction
  glm::vec2 corner{0.f};   // (right, up) coordinates of pixel (0, 0)'s outer corner [m]
  float pixel_size = 0.f;  // side of a pixel [m]
  glm::ivec2 size{0};      // [pixel]
};

// The frame of a mesh's map; `resolution` >= 1: pixels along the longer side.
OpacityMapFrame opacityMapFrame(const TreeMesh& mesh, Direction along, int resolution);

// (D3) Deep opacity map (Yuksel & Keyser 2008): an orthographic picture of a tree along one direction that keeps, for
// every pixel, all leaf crossings in order, so that depths are exact in count, and the first wood, behind which no
// direct light comes. Immutable after it is made.
class DeepOpacityMap {
 public:
  // The plain arrays that a map consists of, each as the function of its name below tells it.
  struct Arrays {
    std::unique_ptr<std::uint32_t[]> first;
    std::unique_ptr<Crossing[]> crossings;
    std::unique_ptr<float[]> wood_depth, last_wood_depth;  // none where they were not looked for
  };
  // Which wood is looked for on each line.
  enum class Wood { none, first, first_and_last };

  // `resolution` >= 1: pixels along the longer side. Without wood half of the work is saved. Works in parallel.
  DeepOpacityMap(const TreeMesh& mesh, Direction along, int resolution, Wood wood = Wood::first);
  // A map that was made elsewhere, as on a graphics card (D14).
  DeepOpacityMap(const OpacityMapFrame& frame, Arrays arrays);

  Direction along() const { return frame_.axes.along; }
  const OpacityMapFrame& frame() const { return frame_; }
  const Axes& axes() const { return frame_.axes; }
  glm::vec2 corner() const { return frame_.corner; }
  float pixelSize() const { return frame_.pixel_size; }
  glm::ivec2 size() const { return frame_.size; }

  // All crossings, pixel by pixel, sorted by depth: those of pixel (x, y) are [first[i], first[i + 1]), i = y * width +
  // x.
  std::span<const std::uint32_t> first() const { return {arrays_.first.get(), pixelNumber(0, frame_.size.y) + 1}; }
  std::span<const Crossing> crossings() const { return {arrays_.crossings.get(), first().back()}; }
  std::span<const Crossing> crossings(int x, int y) const;
  // Depth of the first wood in each pixel [m]; infinity where there is none; empty in a map made without wood.
  std::span<const float> woodDepth() const { return ofPixels(arrays_.wood_depth); }
  // Depth of the last wood in each pixel [m]; -infinity where there is none; empty unless asked for.
  std::span<const float> lastWoodDepth() const { return ofPixels(arrays_.last_wood_depth); }

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
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(frame_.size.x) + static_cast<std::size_t>(x);
  }

  std::span<const float> ofPixels(const std::unique_ptr<float[]>& values) const {
    return {values.get(), values ? pixelNumber(0, frame_.size.y) : 0};
  }

  OpacityMapFrame frame_;
  Arrays arrays_;
};

// Makes the map of a mesh as DeepOpacityMap's constructor does, wherever that is quicker.
using MapMaker =
    std::function<DeepOpacityMap(const std::shared_ptr<const TreeMesh>& mesh, Direction along, int resolution)>;

}  // namespace sunfleck
