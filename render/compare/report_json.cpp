#include "render/compare/report_json.hpp"

#include <nlohmann/json.hpp>
#include <numbers>

namespace sunfleck {
namespace {

using Json = nlohmann::ordered_json;

Json orNull(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

void add(Json& json, const Validation& v) {
  const double degrees = 180. / std::numbers::pi;
  json["scene"] = {{"name", v.scene.name},
                   {"source", sourceOf(v.scene)},
                   {"periodic", v.scene.stand.period.has_value()},
                   {"trees", v.scene.stand.trees.size()},
                   {"leaves", v.leaves},
                   {"leaf_triangles", v.leaf_triangles},
                   {"leaf_area_m2", v.leaf_area},
                   {"mean_depth", v.mean_depth},
                   {"mean_thickness", v.mean_thickness},
                   {"albedo", v.albedo()},
                   {"sun_zenith_deg", double{v.scene.sun().zenith} * degrees},
                   {"wood", v.effort.with_wood}};
  json["reference"] = {{"paths", v.reference.paths},
                       {"seed", v.effort.trace.seed},
                       {"seconds", v.reference.seconds},
                       {"cpu_seconds", v.reference.cpu_seconds},
                       {"rms_noise", orNull(v.reference_noise)},
                       {"rms_noise_weighted", orNull(v.category_noise)},
                       {"categories", v.categories.size()},
                       {"leaves_left_out", v.leaves_left_out}};
  Json models = Json::array();
  for (const ModelResult& m : v.models)
    models.push_back({{"name", nameOf(m.model)},
                      {"rms_category", orNull(m.errors.rms_category)},
                      {"rms_weighted", orNull(m.errors.rms_weighted)},
                      {"rms_leaf", orNull(m.errors.rms_leaf)},
                      {"bias", orNull(m.errors.bias)},
                      {"prepare_seconds", m.prepare_seconds},
                      {"shade_seconds", m.shade_seconds}});
  json["models"] = models;
}

}  // namespace

std::string reportJson(std::span<const Validation> validations, const std::string& version, const std::string& commit) {
  Json json{{"sunfleck", version}, {"commit", commit}};
  add(json, validations.front());
  if (validations.size() > 1) add(json["periodic"], validations[1]);
  // Names of files need not be UTF-8; JSON must.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace sunfleck
