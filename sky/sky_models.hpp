#pragma once

#include <cstddef>
#include <glm/vec3.hpp>

#include "core/image.hpp"
#include "sky/sky_map.hpp"

namespace sunfleck {

// (R17) Skies that give a horizontal plane this irradiance [1], per band.
SkyMap uniformSky(const glm::dvec3& irradiance);   // the same radiance from everywhere
SkyMap overcastSky(const glm::dvec3& irradiance);  // CIE standard overcast: radiance as (1 + 2 cos zenith) / 3

// The same sky, in each band as bright as it takes to give a horizontal plane this irradiance [1]. Throws InvalidInput
// where it gives none and is to give some, and on an irradiance that is not finite and >= 0.
SkyMap withIrradiance(const SkyMap& sky, const glm::dvec3& irradiance);

// The upper half of a panorama in latitude and longitude, each pixel a cell; the lower half, the ground's, is not used.
// Seen from within: to the right the azimuth falls.
//   image     channels R, G and B, or else the first for all bands; an even number of rows, from the zenith on top to
//             the nadir; values finite [1/sr]
//   rotation  azimuth of the middle column [rad], in [-90, 90]
// Throws InvalidInput on another image or rotation.
struct ImageSky {
  SkyMap sky;
  std::size_t negative_values = 0;  // of the upper half, as compression leaves them: taken for 0
};
ImageSky imageSky(const Image& image, double rotation);

}  // namespace sunfleck
