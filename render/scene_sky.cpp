#include "render/scene_sky.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "core/require.hpp"
#include "render/image_file.hpp"
#include "render/scene.hpp"
#include "sky/preetham.hpp"
#include "sky/sky_models.hpp"

namespace sunfleck {
namespace {

// Preetham's sky may give this many times the light of its sun.
constexpr double kMostOfSun = 1000.;

double luminance(const glm::dvec3& rgb) {
  return glm::dot(rgb, {0.2126, 0.7152, 0.0722});
}

SkyMap asBright(const SkyMap& sky, const SceneSky& as) {
  const glm::dvec3 own = sky.irradiance(), wanted = *as.irradiance;
  if (!as.own_colours) return withIrradiance(sky, wanted);
  const double mean = (own.x + own.y + own.z) / 3.;
  require(mean > 0., "irradiance that the sky's own radiance gives", mean, "above 0");
  return sky.scaled(glm::dvec3(wanted.x / mean));
}

}  // namespace

void readSkyImage(SceneSky& sky) {
  ImageSky image = imageSky(readRadiances(sky.file), double{sky.rotation});
  sky.negative_values = image.negative_values;
  sky.image = std::make_shared<const SkyMap>(std::move(image.sky));
}

SunAndSky sunAndSky(const Scene& scene) {
  const SceneSky& asked = scene.sky;
  SunAndSky light;
  for (const Sun& sun : scene.suns) light.suns.push_back(sun.up() ? sun.irradiance : glm::vec3(0.f));
  const auto keep = [&](const SkyMap& sky) { light.sky = std::make_shared<const SkyMap>(sky); };
  switch (asked.kind) {
    case SceneSky::Kind::none:
      break;
    case SceneSky::Kind::uniform:
      keep(uniformSky(*asked.irradiance));
      break;
    case SceneSky::Kind::overcast:
      keep(overcastSky(*asked.irradiance));
      break;
    case SceneSky::Kind::image:
      keep(asBright(*asked.image, asked));
      break;
    case SceneSky::Kind::preetham: {
      if (!scene.sun().up()) break;
      const ClearSky clear = preethamSky(double{scene.sun().zenith}, double{scene.sun().azimuth}, asked.turbidity);
      const double sun = luminance(clear.sun);
      if (asked.irradiance) {
        keep(asBright(clear.sky, asked));
      } else {
        const double of_sun = luminance(clear.sky.irradiance()) / sun;
        require(of_sun <= kMostOfSun, "light of Preetham's sky, of that of its sun", of_sun,
                "at most 1000, or told by [sky] irradiance: next to nothing of so low a sun comes through the air");
        keep(clear.sky.scaled(glm::dvec3(1. / sun)));
      }
      if (asked.coloured_sun) light.suns.front() *= glm::vec3(clear.sun / sun);
      break;
    }
  }
  return light;
}

}  // namespace sunfleck
