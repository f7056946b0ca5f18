#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "render/gl/tree_levels.hpp"

namespace sunfleck::gl::detail {

// A triangle that is to be put into a level.
struct LevelTriangle {
  std::array<glm::vec3, 3> corners;
  std::array<std::uint32_t, 3> shared;  // numbers of the corners, the same where triangles share one
  glm::vec3 middle{0.f};                // see TriangleData
  std::uint32_t leaf = TriangleData::kNoLeaf;
  float enlargement = 1.f;
  std::uint32_t source = 0;  // see TreeLevels
};

// Puts the levels of a tree together.
class LevelBuilder {
 public:
  explicit LevelBuilder(TreeLevels& levels) : levels_(levels) {}

  // Adds triangles, which get the next numbers, and the level that they make.
  //   shared_count  numbers that corners have
  void add(std::vector<Level>& into, const std::vector<LevelTriangle>& triangles, std::size_t shared_count,
           float piece_area);
  // To be called when all is added: vertices that no triangle owns come after all others.
  void finish();

 private:
  static constexpr std::uint32_t kExtra = 1u << 31;
  TreeLevels& levels_;
  std::vector<glm::vec3> owned_, extra_;
};

}  // namespace sunfleck::gl::detail
