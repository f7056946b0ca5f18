#pragma once

#include <vector>

namespace sunfleck {

// Albedo of the ground in one band of light as an image without end: its lower left corner lies at x = y = 0, its upper
// edge towards +y, and it repeats every `size` metres along x and, as its pixels are squares, every
// size * height / width along y.
struct GroundTexture {
  int width = 0, height = 0;  // [pixel], > 0
  float size = 1.f;           // [m], > 0
  std::vector<float> albedo;  // Lambertian [1], 0 .. 1, rows from top to bottom

  // Linear between the centres of pixels, so that its mean is that of the pixels.
  float at(double x, double y) const;
};

// Throws InvalidInput on a texture without pixels, a size that is not above 0 and finite, and an albedo out of 0 .. 1.
void validate(const GroundTexture& texture);

}  // namespace sunfleck
