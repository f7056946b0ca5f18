#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <span>
#include <vector>

#include "render/gl/detail/frame_data.hpp"
#include "render/gl/tree_levels.hpp"
#include "render/gl/view.hpp"

namespace sunfleck::gl {

// A draw call, as OpenGL reads it from memory.
struct DrawCommand {
  std::uint32_t index_count = 0, instance_count = 0, first_index = 0;
  std::int32_t base_vertex = 0;
  std::uint32_t base_instance = 0;
};

// What of a kind's trees is drawn.
struct VisibleTrees {
  std::vector<detail::DrawnData> instances;  // that commands count from their base_instance
  std::vector<DrawCommand> commands;
  std::size_t triangles = 0;
};

// Leaves out the trees and clusters beside the view, and chooses levels of detail (R25).
//   trees            of this kind
//   clip_from_world  of the view
VisibleTrees visibleTrees(const TreeLevels& levels, std::span<const detail::DrawnData> trees, const View& view,
                          const glm::mat4& clip_from_world);

}  // namespace sunfleck::gl
