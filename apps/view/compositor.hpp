#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "apps/view/canvas.hpp"
#include "apps/view/session.hpp"
#include "core/image.hpp"
#include "render/gl/buffer.hpp"
#include "render/gl/frame_target.hpp"
#include "render/gl/program.hpp"

namespace sunfleck::view {

// A texture of four numbers per pixel, rows from bottom to top, to be shown.
struct Shown {
  unsigned texture = 0;
  float scale = 1.f;  // by which its radiances count: one over the samples
  Layer layer = Layer::total;
};

// Makes colours of radiances: exposure and tone curve, A beside B, or their difference.
class Compositor {
 public:
  Compositor();
  ~Compositor();
  Compositor(const Compositor&) = delete;
  Compositor& operator=(const Compositor&) = delete;

  //   difference_scale  radiance of the last colour [1/sr], > 0
  void draw(const Canvas& canvas, const Shown& a, const std::optional<Shown>& b, const Look& look,
            float difference_scale) const;

 private:
  gl::Program program_;
  unsigned array_ = 0, colours_ = 0;  // names of an empty vertex array and of the colours of differences
};

// A picture in a texture, for Shown.
class ImageTexture {
 public:
  void set(const Image& image);  // channels R, G, B first
  void clear() { texture_.reset(); }
  std::optional<Shown> shown() const;

 private:
  static void destroy(unsigned name);
  std::optional<gl::ObjectName<&ImageTexture::destroy>> texture_;
};

// The layer of a frame in which it is found.
gl::Layer frameLayer(Layer layer);

}  // namespace sunfleck::view
