#include "render/detail/scene_light_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <glm/trigonometric.hpp>
#include <map>

#include "core/require.hpp"
#include "sky/preetham.hpp"
#include "sky/solar_position.hpp"

namespace sunfleck::detail {
namespace {

// By date, time and place, in place of angles.
void placeByMoment(Sun& sun, const std::string& origin, SceneTable& table, const std::array<const char*, 4>& keys) {
  for (const char* key : keys)
    if (!table.has(key))
      throw InvalidInput(
          fmt::format("{}: [sun] has no key {}: must have all of {}", origin, key, fmt::join(keys, ", ")));
  for (const char* key : {"zenith_deg", "azimuth_deg"})
    if (table.has(key))
      throw InvalidInput(fmt::format("{}: [sun] has both {} and date: must be one of them", origin, key));
  const std::string date = table.moment("date"), time = table.moment("time");
  const SolarPosition stands =
      solarPosition(utcMoment(date, time, origin + ": sun."),
                    glm::radians(table.number("latitude_deg", 0., -90., 90., "in [-90, 90]")),
                    glm::radians(table.number("longitude_deg", 0., -180., 180., "in [-180, 180]")));
  sun.zenith = static_cast<float>(stands.zenith);
  sun.azimuth = static_cast<float>(stands.azimuth);
}

Sun readSun(const std::string& origin, SceneTable table) {
  Sun sun;
  static constexpr std::array of_moment{"date", "time", "latitude_deg", "longitude_deg"};
  if (std::ranges::any_of(of_moment, [&](const char* key) { return table.has(key); })) {
    placeByMoment(sun, origin, table, of_moment);
  } else {
    sun.zenith = table.degrees("zenith_deg", 0., 180., "in [0, 180]");
    sun.azimuth = table.degrees("azimuth_deg", -360., 360., "in [-360, 360]");
  }
  sun.irradiance = table.perBand("irradiance", sun.irradiance, 10.);
  sun.diameter = table.degreesOrZero("diameter_deg", 0.25, 60.);  // as Monte Carlo takes it
  table.done();
  return sun;
}

}  // namespace

void readSuns(Scene& scene, const toml::node* node, const std::filesystem::path& file) {
  const toml::array* several = node ? node->as_array() : nullptr;  // [[sun]]
  if (several && (several->empty() || several->size() > kMostSuns))
    throw InvalidInput(fmt::format("{}:{}: number of [[sun]] = {}: must be from 1 to {}", file.string(),
                                   node->source().begin.line, several->size(), kMostSuns));
  scene.suns.clear();
  for (std::size_t i = 0; i < (several ? several->size() : 1); ++i)
    scene.suns.push_back(readSun(scene.origin, SceneTable(several ? several->get(i) : node, file.string(), "sun")));
}

void readSky(Scene& scene, SceneTable sky, const std::filesystem::path& folder) {
  constexpr double kMostIrradiance = 1000.;
  using Kind = SceneSky::Kind;
  static const std::map<std::string, Kind> kinds{{"none", Kind::none},
                                                 {"uniform", Kind::uniform},
                                                 {"overcast", Kind::overcast},
                                                 {"preetham", Kind::preetham},
                                                 {"image", Kind::image}};
  const std::string name = sky.text("kind", "none");
  const auto kind = kinds.find(name);
  if (kind == kinds.end())
    throw InvalidInput(scene.origin + ": sky.kind = \"" + name +
                       "\": must be none, uniform, overcast, preetham or image");
  SceneSky& read = scene.sky;
  read.kind = kind->second;
  if (read.kind != Kind::none) {
    read.own_colours = !sky.isList("irradiance");
    if (read.kind != Kind::preetham || sky.has("irradiance"))
      read.irradiance = sky.perBand("irradiance", glm::vec3(glm::dvec3(kSkyIrradiance)), kMostIrradiance);
  }
  if (read.kind == Kind::preetham) {
    read.turbidity = sky.number("turbidity", read.turbidity, kLeastTurbidity, kMostTurbidity, "in [1.7, 10]");
    read.coloured_sun = sky.flag("coloured_sun", read.coloured_sun);
  }
  if (read.kind == Kind::image) {
    if (!sky.has("file")) throw InvalidInput(scene.origin + ": [sky] of kind \"image\" has no key file");
    read.file = (folder / sky.text("file", "")).string();
    read.rotation = sky.degrees("rotation_deg", -360., 360., "in [-360, 360]");
    readSkyImage(read);
  }
  sky.done();
}

}  // namespace sunfleck::detail
