#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/directions.hpp"
#include "core/progress.hpp"
#include "core/tree_mesh.hpp"
#include "field/elements.hpp"

namespace sunfleck {

// (F3) Lines of a sun's light, one through each pixel of a picture that is too large to be held: a map from space to
// pixels across the light and the depth along it.
struct SunLines {
  Direction along{0.f, 0.f, -1.f};
  glm::dvec3 right{0.}, up{0.}, depth{0.};  // pixels per metre; metres per metre
  double line_area = 0.;                    // that a line stands for, across the light [m^2]
  std::optional<glm::ivec2> repeat{};       // pixels of a period
  bool mirrored = false;                    // whether right, up and depth are left-handed
};
//   along  z < 0
//   area   that a line stands for; with a period as near as whole numbers of pixels come to it [m^2]
SunLines sunLines(Direction along, double area, const std::optional<glm::vec2>& period);

// What the sun sees of a tree that stands alone at the origin: of each pixel the first side of an element on its line.
struct TreePicture {
  glm::ivec2 low{0}, size{0};       // first pixel, and how many
  std::vector<float> depth;         // of the side along the light, infinite where there is none [m]
  std::vector<std::uint32_t> side;  // 2 element (front) or 2 element + 1 (back)
};
TreePicture treePicture(const TreeMesh& mesh, const FieldElements& elements, float rotation, const SunLines& lines);

// Which pixels of a tree's picture the sun reaches: those that show something, where no other tree is before it.
class LitPixels {
 public:
  LitPixels() = default;
  explicit LitPixels(const TreePicture& picture) : bits_((picture.side.size() + kBits - 1) / kBits) {}
  bool lit(std::size_t pixel) const { return (bits_[pixel / kBits] >> (pixel % kBits) & 1u) != 0; }
  // Pixels number `word` times 64 and on; may be called by several threads.
  void add(std::size_t word, std::uint64_t lit) {
    std::atomic_ref(bits_[word]).fetch_or(lit, std::memory_order_relaxed);
  }
  static constexpr std::size_t kBits = 64;

 private:
  std::vector<std::uint64_t> bits_;
};

// A tree before the sun.
struct SunlitTree {
  const TreePicture* picture = nullptr;
  std::size_t sides = 0;        // of its elements
  glm::vec3 position{0.f};      // [m]
  LitPixels* pixels = nullptr;  // where they are told; none: nowhere
};

// Part of the whole picture: depths of what the sun sees, row by row, infinite where it is nothing.
struct SunTile {
  glm::ivec2 low{0}, size{0};  // [pixel]
  std::size_t stride = 0;      // from one row to the next
  std::span<const float> depth;
};

// (F3) The stand as the sun sees it, tile by tile: in each pixel the first tree that has something on its line. Calls
// from many threads, in any order:
//   lit   a tree, and of each side of its elements how many lines come to it within a tile
//   seen  a whole tile; may be none
// Throws std::runtime_error("interrupted") when `progress`, told after each tile, ends it.
void shineOn(std::span<const SunlitTree> trees, const SunLines& lines,
             const std::function<void(std::size_t tree, std::span<const std::uint32_t> of_sides)>& lit,
             const std::function<void(const SunTile& tile)>& seen, const Progress& progress = {});

}  // namespace sunfleck
