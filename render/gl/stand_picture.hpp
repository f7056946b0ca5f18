#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/image.hpp"
#include "core/progress.hpp"
#include "render/gl/drawn_stand.hpp"
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

// The same of a scene, with a context of its own; `geometry` is up to date for it. Needs no display. Throws TooLarge
// too, and std::runtime_error when there is no OpenGL 4.5.
Image scenePicture(const Scene& scene, const StandGeometry& geometry, const PictureEffort& effort,
                   const Progress& progress = {});

std::string nameOf(Layer layer);

}  // namespace sunfleck::gl
