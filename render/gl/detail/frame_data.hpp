#pragma once

#include <array>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

// What the shaders read, as they lay it out: the C++ side of frame.glsl, where each field is explained.
namespace sunfleck::gl::detail {

struct LightFrame {
  glm::vec4 right{0.f}, up{0.f}, travel{0.f};
  glm::uvec4 grid{0u};
};

struct FrameData {
  glm::mat4 clip_from_world{1.f};
  glm::vec4 eye{0.f}, sight{0.f}, corner{0.f}, pixel_right{0.f}, pixel_up{0.f};
  glm::vec4 ground{0.f}, ground_albedo{0.f}, period{0.f}, sky_azimuth{0.f}, ground_cells{0.f}, ground_open{0.f};
  glm::vec4 cell_part{1.f};
  glm::uvec4 counts{0u};
  std::array<LightFrame, 4> lights{};

  bool hasSky() const { return counts.y > 0u; }
};
static_assert(sizeof(FrameData) == 64 + 13 * 16 + 4 * 64);

struct TreeData {
  glm::vec3 position{0.f};
  std::uint32_t kind = 0;
  glm::uvec3 cells{0u};
  std::uint32_t told = 0;  // bit 0: whether it has cells; bit 1: far; above: field
};

struct DrawnData {
  glm::vec3 position{0.f};
  std::uint32_t number = 0;
};

struct Standing {
  glm::vec3 position{0.f};
  std::uint32_t tree = 0;
};

struct KindFrame {
  glm::vec4 cell_low{0.f, 0.f, 0.f, 1.f};
  glm::uvec4 cell_count{1u, 1u, 1u, 0u};
  glm::uvec4 images{0u};
};

struct MapFrame {
  glm::vec4 origin{0.f, 0.f, 0.f, 1.f}, corner{0.f};
  glm::uvec4 size{0u};
};

struct MapLine {
  std::uint32_t first, end;
  float wood_depth;
};

inline constexpr std::uint32_t kNone = ~0u, kGround = ~0u - 1;

}  // namespace sunfleck::gl::detail
