#pragma once

#include "core/image.hpp"

namespace sunfleck {

// (R31) How far a picture is off from a reference, relative to the reference's radiance: root mean square over pixels
// and bands, pixels weighted by how much of them the picture covers.
struct PictureError {
  double rms = 0.;             // with the noise that the reference has [1]
  double noise = 0.;           // what of it is the reference's noise alone [1]
  double without_noise = 0.;   // the rest, by their squares; 0 where the noise is all [1]
  double standard_error = 0.;  // of that, from the noise [1]
  double bias = 0.;            // of the sum of all radiance [1]
};

// Both have channels R, G and B, and the picture may have A, its coverage. `standard_error`: of the reference, if it
// has any. Throws std::invalid_argument on pictures of different sizes or other channels.
PictureError pictureError(const Image& picture, const Image& reference, const Image* standard_error = nullptr);

// Channel Y: the difference of each pixel, root mean square over the bands [1/sr], 0 where the picture covers nothing.
// Throws as above.
Image differencePicture(const Image& picture, const Image& reference);

// A picture of channel Y in false colours from 0 to `high`, as light that a PNG of exposure 1 shows.
Image inFalseColours(const Image& values, float high);

// The same with a bar of the colours beside it on the right, and the numbers that they stand for; with `percent`, times
// 100 and so named.
Image withColourBar(const Image& false_colours, float high, bool percent);

}  // namespace sunfleck
