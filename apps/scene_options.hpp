#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/import_options.hpp"
#include "apps/leaf_options.hpp"
#include "apps/run_options.hpp"
#include "render/scene.hpp"

namespace sunfleck::apps {

// The scene a command works on, and what the command line changes in it.
struct SceneOptions {
  std::string scene = "cherry";
  ImportOptions import;         // of a mesh file
  std::optional<float> albedo;  // reflectance = transmittance = albedo / 2 in all bands
  LeafOptions leaves;           // in place of it
  std::optional<double> sun_zenith_deg, sun_azimuth_deg;
  std::string date;                          // and time, as in 2003-10-17T12:30:30-07:00
  std::optional<std::vector<double>> place;  // latitude, longitude [degree]
  std::optional<std::vector<float>> period;
};
void addSceneOptions(CLI::App& command, SceneOptions& options);
// Scenes with media, and those in which no tree stands, are refused where nothing is done with them.
enum class Media { refused, taken };
enum class Treeless { refused, taken };
Scene readScene(const SceneOptions& options, Media media = Media::refused, Treeless treeless = Treeless::refused);

// The camera, as far as the command line changes it.
struct CameraOptions {
  std::string saved;  // name of a saved one to begin with
  std::optional<double> elevation_deg, azimuth_deg, field_of_view_deg;
  std::optional<float> half_width;
  std::optional<std::vector<float>> target;
  std::optional<std::vector<int>> size;
  bool given() const {
    return !saved.empty() || elevation_deg || azimuth_deg || half_width || field_of_view_deg || target || size;
  }
};
//   target_name  of the option for the point in the middle; where --target is an error, --look-at alone
void addCameraOptions(CLI::App& command, CameraOptions& options, const std::string& target_name = "--look-at,--target");
void apply(const CameraOptions& options, Scene& scene);

}  // namespace sunfleck::apps
