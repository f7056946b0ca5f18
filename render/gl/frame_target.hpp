#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

#include "render/gl/object_name.hpp"
#include "render/gl/view.hpp"

namespace sunfleck::gl {

// What a frame leaves in textures. Radiances are sums over the samples drawn since the last view that did not
// accumulate; all others are of the last sample.
enum class Layer {
  total,     // radiance R, G, B; A: coverage by trees and ground
  direct,    // of sunlight scattered once
  single,    // of sunlight scattered twice, by models that tell
  multiple,  // of other sunlight
  sky,       // of the sky's light, scattered or seen behind all
  geometry,  // normal towards the eye, and distance from the eye or the target's plane along the middle line of sight
             // [m]
  foliage,   // n+, n-, visible share of the first light, G
  ids,       // drawn tree or kGround or kNone, its triangle, its kind, its leaf; bits of whole numbers
};
inline constexpr int kLayers = 8;
inline constexpr std::array kLayersBesideTotal{Layer::direct,   Layer::single,  Layer::multiple, Layer::sky,
                                               Layer::geometry, Layer::foliage, Layer::ids};

// The textures that frames are drawn into, in the current context.
class FrameTarget {
 public:
  // Throws TooLarge on a size beyond OpenGL's.
  //   layers  whether it has more than the total
  explicit FrameTarget(glm::ivec2 size, bool layers = false);

  glm::ivec2 size() const { return size_; }
  bool hasLayers() const { return textures_.size() > 1; }
  unsigned texture(Layer layer) const { return textures_[static_cast<std::size_t>(layer)].get(); }
  int samples() const { return samples_; }  // that the radiances are sums of

  // Four numbers for each pixel, rows from bottom to top. Radiances are divided by the samples.
  std::vector<float> read(Layer layer) const;
  std::vector<std::uint32_t> readIds() const;

  // What is seen at a pixel, from the lower left: drawn tree (or kNone: none, the ground may be seen) and triangle.
  glm::uvec2 visibleAt(glm::ivec2 pixel) const;

  // For drawing: triangles that are seen, as pairs of drawn tree and triangle.
  void beginVisible() const;
  void setVisible(std::span<const glm::uvec2> ids);
  unsigned visible() const { return visible_.get(); }
  // Radiances are added to where `accumulate` is set. Pixels beyond `shown` show nothing and are not drawn.
  void beginShading(bool accumulate, const PixelBox& shown);

 private:
  static void destroyFramebuffer(unsigned name);
  static void destroyRenderbuffer(unsigned name);
  static void destroyTexture(unsigned name);
  using Texture = ObjectName<&FrameTarget::destroyTexture>;
  using Framebuffer = ObjectName<&FrameTarget::destroyFramebuffer>;
  static Texture texture(unsigned format, glm::ivec2 size);

  void clearLayers() const;

  glm::ivec2 size_;
  int samples_ = 0;
  Texture visible_;
  ObjectName<&FrameTarget::destroyRenderbuffer> depth_;
  std::vector<Texture> textures_;
  Framebuffer visible_target_, shading_target_;
};

}  // namespace sunfleck::gl
