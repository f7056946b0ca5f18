#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/image.hpp"
#include "core/progress.hpp"
#include "render/gl/drawn_stand.hpp"
#include "render/gl/frame_target.hpp"
#include "render/gl/stand_renderer.hpp"
#include "render/model.hpp"

namespace sunfleck::gl {

// How a picture is made of frames.
struct PictureEffort {
  Model model = Model::sppg;
  int samples = 4;            // for each pixel, > 0
  float piece_pixels = 0.f;   // see View
  std::vector<Layer> layers;  // beside the total; single is left out where the model does not tell it
  spp::PowerTableOf exact;    // see StandRenderer
  // Finds what is seen in a view into a target of that size, as StandRenderer::draw() is told; none: it is drawn.
  std::function<std::vector<glm::uvec2>(const View& view, const glm::ivec2& size)> visible{};
};

// (R3) The renderer's stand seen by a camera. Channels R, G, B: linear radiance [1/sr], the mean over each pixel's
// samples; A: coverage by trees and ground [1]. Then those of the layers, named like direct.R; depths, normals, foliage
// and ids are those in the middle of the pixel, -1 for the id of nothing. Pictures are drawn in tiles, so that memory
// is bounded. The same picture is the same bits on the same driver. Throws InvalidInput on a camera that sees nothing
// and std::runtime_error("interrupted") when `progress` ends it.
Image standPicture(const Context& context, StandRenderer& renderer, const Camera& camera, const PictureEffort& effort,
                   const Progress& progress = {});

// The same picture by one frame at a time, for a thread that has other things to draw, too: the renderer may draw other
// views between them, but of the same stand. Throws as standPicture() does.
class PictureByFrames {
 public:
  PictureByFrames(const Context& context, StandRenderer& renderer, const Camera& camera, PictureEffort effort);
  bool complete() const { return frame_ == frames(); }
  double done() const { return static_cast<double>(frame_) / frames(); }  // share of the frames
  void drawFrame();                                                       // unless it is complete
  Image take() { return std::move(image_); }                              // once, when it is complete

 private:
  int frames() const { return tiles_.x * tiles_.y * frames_of_tile_; }
  void copyLayers(bool sums);

  const Context* context_;
  StandRenderer* renderer_;
  PictureEffort effort_;
  View view_;
  Image image_;
  std::vector<Layer> layers_;
  std::vector<std::size_t> first_channel_;  // of each layer
  glm::ivec2 tile_, tiles_;
  int frames_of_tile_;  // one in the middle of the pixels first, where there are layers
  std::optional<FrameTarget> target_;
  int frame_ = 0;  // that comes next
};

// The same of a scene, with a context of its own; `geometry` is up to date for it. Needs no display. Throws TooLarge
// too, and std::runtime_error when there is no OpenGL 4.5.
Image scenePicture(const Scene& scene, const StandGeometry& geometry, const PictureEffort& effort,
                   const Progress& progress = {});

std::string nameOf(Layer layer);

}  // namespace sunfleck::gl
