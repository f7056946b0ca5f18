#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sky/sky_map.hpp"

namespace sunfleck {

struct Scene;

inline constexpr double kSkyIrradiance = 0.2;  // of skies that are not told theirs

// The sky that a scene asks for; where the sun stands is the scene's.
struct SceneSky {
  enum class Kind { none, uniform, overcast, preetham, image };
  Kind kind = Kind::none;
  // Of a horizontal plane, relative to that of a plane facing a sun of 1 [1], per band; none: what Preetham's sky
  // gives. With `own_colours` a sky of colours keeps them, and this is the mean of its bands.
  std::optional<glm::dvec3> irradiance{};
  bool own_colours = true;
  double turbidity = 3.;      // of Preetham's [1]
  bool coloured_sun = false;  // by Preetham's air, at the same luminance
  std::string file{};         // of the image
  float rotation = 0.f;       // of the image: azimuth of its middle column, from +x towards +y [rad]
  std::shared_ptr<const SkyMap> image{};
  std::size_t negative_values = 0;  // of the image, taken for 0
  bool operator==(const SceneSky&) const = default;
};

// Reads the image of a sky that names its file, turned by its rotation. Throws InvalidInput as readRadiances() and
// imageSky() do.
void readSkyImage(SceneSky& sky);

// The light of a scene, per band. Preetham's sky is black when its sun has set.
struct SunAndSky {
  std::vector<glm::vec3> suns;          // of each, irradiance of a plane that faces it [1]; 0 of those that have set
  std::shared_ptr<const SkyMap> sky{};  // none where there is none
};
// Throws InvalidInput where the sky cannot be as bright as it is to be: an image that is black in a band, or Preetham's
// under a sun so low that next to nothing of it comes through the air.
SunAndSky sunAndSky(const Scene& scene);

}  // namespace sunfleck
