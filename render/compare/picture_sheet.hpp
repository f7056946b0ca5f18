#pragma once

#include <string>
#include <vector>

#include "core/image.hpp"
#include "render/compare/picture_difference.hpp"
#include "render/tone_mapping.hpp"

namespace sunfleck {

// A picture to be held against a reference.
struct ComparedPicture {
  std::string model;
  Image picture;
  PictureError error;
};

// The reference and the pictures side by side, as the display shows them, and below each its difference from the
// reference in false colours, all up to the same value, with a bar on the right [1/sr]; as light that a PNG of
// exposure 1 shows. All have one size and channels R, G and B first.
Image pictureSheet(const Image& reference, const std::vector<ComparedPicture>& pictures, const Display& display);

// Rows of a table in CSV, with their header: scene, model, and the fields of PictureError.
std::string pictureErrorHeader();
std::string pictureErrorRows(const std::string& scene, const std::vector<ComparedPicture>& pictures);

}  // namespace sunfleck
