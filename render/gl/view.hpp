#pragma once

#include <array>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "core/bounds.hpp"
#include "render/camera.hpp"
#include "render/model.hpp"

namespace sunfleck::gl {

// What is drawn of a stand, and how.
struct View {
  Camera camera;
  Model model = Model::sppg;
  glm::ivec2 low{0};         // lower left pixel of the target, in the camera's picture from its lower left
  glm::vec2 offset{0.f};     // of the sample in each pixel from its middle [pixel]
  bool accumulate = false;   // add to the radiances that the target holds
  float piece_pixels = 0.f;  // leaves and twigs are drawn fewer and larger, up to so many pixels (R25); 0: as they are
};

// Of the samples of a picture: each pair lies opposite about the middle of the pixel, so that the mean over the pixel
// of what is linear in it is exact. An even count of samples is the first so many from number 1 on; number 0 is the
// middle. The pairs follow the R2 sequence (Roberts 2018) [pixel].
glm::vec2 sampleOffset(int number);

// Clip coordinates (x, y in -1 .. 1 over the target, z from 1 near to 0 far) of a view into a target of `size` pixels.
//   reach  everything lies within this distance of the camera's target [m]
glm::mat4 clipFromWorld(const View& view, glm::ivec2 size, float reach);

// Left, right, bottom and top of what clip coordinates hold: dot(xyz, point) + w >= 0 within.
std::array<glm::vec4, 4> sidesOf(const glm::mat4& clip_from_world);

// Pixels of a target, from the lower left.
struct PixelBox {
  glm::ivec2 low{0}, high{0};  // high is beyond the last
  bool operator==(const PixelBox&) const = default;
};
// Pixels in which a box [m] may be seen, of a target of `size` pixels: all where a part of it is behind the eye.
PixelBox pixelsOf(const Bounds& box, const glm::mat4& clip_from_world, glm::ivec2 size);

// Pixels along a metre that faces the camera, at a distance from the eye.
float pixelsPerMetre(const Camera& camera, float distance);

}  // namespace sunfleck::gl
