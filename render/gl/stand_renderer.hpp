#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <span>

#include "render/gl/context.hpp"
#include "render/gl/drawn_stand.hpp"
#include "render/gl/frame_target.hpp"
#include "render/gl/stand_data.hpp"
#include "render/gl/view.hpp"
#include "spp/power_table.hpp"

namespace sunfleck::gl {

// What a frame took, and what it drew.
struct FrameCost {
  std::size_t triangles = 0, draw_calls = 0;
  double visible_seconds = 0., shading_seconds = 0.;  // 0 where it was not timed
};

// What is seen at a place of the picture.
struct Pick {
  std::optional<std::uint32_t> tree;  // of the stand; a copy in another period counts as the tree
  std::optional<std::uint32_t> leaf;  // of its kind; none for wood and ground
  glm::vec3 place{0.f};               // where the line of sight meets it [m]
};

// (R24) A stand on the GPU, seen by any camera and shaded by any model: what each pixel shows is found first, then
// every pixel is shaded once. A `context` must be current wherever it is used, and outlive it.
class StandRenderer {
 public:
  //   exact  of slabs of a kind of leaves, for models of the exact solution; without it they throw
  //   std::invalid_argument
  explicit StandRenderer(const Context& context, const spp::PowerTableOf& exact = {});
  ~StandRenderer();
  StandRenderer(const StandRenderer&) = delete;
  StandRenderer& operator=(const StandRenderer&) = delete;

  // Sends what has changed since the last update, and says how much. Throws TooLarge with the figure where OpenGL
  // cannot hold the stand.
  Sent update(const DrawnStand& stand);

  // Draws the stand into the target's textures. The same picture is the same bits on the same driver.
  FrameCost draw(const View& view, FrameTarget& target);
  // The same with what is seen told, as pairs of drawn tree and triangle, rows from bottom to top: kNone, kGround.
  FrameCost draw(const View& view, FrameTarget& target, std::span<const glm::uvec2> visible);
  // What the target shows at a pixel, from the lower left, after a frame of that view; none where it is the sky.
  std::optional<Pick> at(glm::ivec2 pixel, const View& view, const FrameTarget& target) const;
  // Waits for the graphics card around each pass, so that costs tell times; slower.
  void timePasses(bool on) { timed_ = on; }

 private:
  struct Programs;
  FrameCost shade(const View& view, FrameTarget& target, FrameCost cost);
  void bindFrame(const View& view, const FrameTarget& target);
  float reach(const View& view) const;
  PixelBox shown(const View& view, glm::ivec2 size) const;

  const Context* context_;
  StandData data_;
  Buffer frame_;
  std::unique_ptr<Programs> programs_;
  bool timed_ = false;
};

}  // namespace sunfleck::gl
