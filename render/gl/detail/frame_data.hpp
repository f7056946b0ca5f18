#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

// What the shaders read, as they lay it out: the C++ side of frame.glsl and foliage.glsl.
namespace sunfleck::gl::detail {

struct FrameData {
  glm::mat4 clip_from_world{1.f};
  glm::vec4 to_eye{0.f};
  glm::vec4 sun{0.f};
  glm::vec4 map_right{0.f}, map_up{0.f}, map_size{0.f};
  glm::vec4 cell_low{0.f}, cell_count{1.f};
  glm::vec4 ground_albedo{0.f};
  glm::vec4 ground{0.f};
  glm::uvec4 choice{0u};
};
static_assert(sizeof(FrameData) == 64 + 9 * 16 + 16);

struct InstanceData {
  glm::vec4 position{0.f};
  glm::uvec4 neighbours{0u};
};
static_assert(sizeof(InstanceData) == 32);

struct NeighbourData {
  glm::vec4 in_map{0.f}, in_space{0.f};
};
static_assert(sizeof(NeighbourData) == 32);

// A corner of a triangle of leaf or wood.
struct VertexData {
  glm::vec3 position;
  std::uint32_t leaf;
  glm::vec3 normal;
};
static_assert(sizeof(VertexData) == 28);

}  // namespace sunfleck::gl::detail
