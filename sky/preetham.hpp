#pragma once

#include <glm/vec3.hpp>

#include "sky/sky_map.hpp"

namespace sunfleck {

// A clear sky and its sun: luminance and illuminance in linear RGB of BT.709, of which 0.2126 R + 0.7152 G + 0.0722 B
// is what the eye measures, and equal bands are white.
struct ClearSky {
  SkyMap sky;      // [kcd/m^2]
  glm::dvec3 sun;  // on a plane that faces it, at the ground [klx]
};

inline constexpr double kLeastTurbidity = 1.7, kMostTurbidity = 10.;
inline constexpr double kMostSunZenith = 1.5690511;  // 89.9 degrees [rad], also when rounded to a float

// (R17) The sky of Preetham, Shirley & Smits 1999, luminance and colour by the formula of Perez et al., and the sun's
// light through the same air (their appendix, after Iqbal). The fits were made for turbidities of 2 to 6: outside,
// and under a sun lower than 75 degrees, sky and sun together are brighter than the light there is. What the three
// bands cannot mix counts as 0 in the band that would be negative.
//   sun_zenith   [rad], 0 .. kMostSunZenith
//   sun_azimuth  where the sun stands [rad], in [-100, 100]
//   turbidity    haze: optical thickness of the air with particles over that without [1], 1.7 .. 10: below, the fits
//                make the zenith black or negative; above, the sky under a low sun
// Throws InvalidInput on a value out of its range.
ClearSky preethamSky(double sun_zenith, double sun_azimuth, double turbidity);

// The same sky at single points: chromaticities x and y and luminance Y [kcd/m^2].
//   cos_zenith  of the point, > 0 [1]      cos_sun  of the angle between point and sun [1]
glm::dvec3 preethamChromaLuminance(double cos_zenith, double cos_sun, double sun_zenith, double turbidity);

}  // namespace sunfleck
