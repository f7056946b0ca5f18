#include "apps/brf_output.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "apps/trace_output.hpp"
#include "core/whole_file.hpp"

namespace sunfleck::apps {
namespace {

using Json = nlohmann::ordered_json;

auto partsOf(const ReflectanceParts& parts) {
  return std::array{std::pair{"leaf_once", parts.leaf_once}, std::pair{"wood_once", parts.wood_once},
                    std::pair{"ground_once", parts.ground_once}, std::pair{"more", parts.more}};
}

}  // namespace

Json jsonOf(const ReflectanceParts& parts, const char* name) {
  Json json = {{name, parts.whole.value}};
  Json errors = {{name, parts.whole.standard_error}};
  for (const auto& [part, estimate] : partsOf(parts)) {
    json[part] = estimate.value;
    errors[part] = estimate.standard_error;
  }
  json["standard_errors"] = errors;
  return json;
}

Json jsonOf(const std::vector<BrfView>& views, const BrfResult& result) {
  Json rows = Json::array();
  for (std::size_t i = 0; i < views.size(); ++i) {
    Json row = {{"view_zenith_deg", views[i].zenith_deg}, {"view_azimuth_deg", views[i].azimuth_deg}};
    row.update(jsonOf(result.views[i], "brf"));
    rows.push_back(row);
  }
  return rows;
}

std::string tableOf(const std::vector<BrfView>& views, const BrfResult& result, const char* name) {
  std::string text = fmt::format("  {:>8} {:>8}  {:^22} {:>9} {:>9} {:>9} {:>9}\n", "zenith", "azimuth", name,
                                 "leaf once", "wood once", "ground", "more");
  const auto add = [&](const ReflectanceParts& parts) {
    text += fmt::format("{:.6f} +- {:.6f}  ", parts.whole.value, parts.whole.standard_error);
    for (const auto& [of_what, part] : partsOf(parts)) text += fmt::format(" {:>9.6f}", part.value);
    text += '\n';
  };
  for (std::size_t i = 0; i < views.size(); ++i) {
    text += fmt::format("  {:>8g} {:>8.5g}  ", views[i].zenith_deg, views[i].azimuth_deg);
    add(result.views[i]);
  }
  text += fmt::format("  {:<17}  ", "hemisphere");
  add(result.albedo);
  return text;
}

void writeBrf(const std::string& file, const std::vector<BrfView>& views, const std::vector<BrfResult>& results,
              const std::vector<std::string>& bands) {
  const bool several = results.size() > 1;
  std::string text = several ? "band," : "";
  text += "view_zenith_deg,view_azimuth_deg,brf,standard_error";
  for (const auto& [name, part] : partsOf({})) text += fmt::format(",{0},{0}_standard_error", name);
  text += '\n';
  for (std::size_t band = 0; band < results.size(); ++band)
    for (std::size_t i = 0; i < views.size(); ++i) {
      const ReflectanceParts& parts = results[band].views[i];
      if (several) text += bands[band] + ",";
      text += fmt::format("{:.9g},{:.9g},{:.9g},{:.4g}", views[i].zenith_deg, views[i].azimuth_deg, parts.whole.value,
                          parts.whole.standard_error);
      for (const auto& [name, part] : partsOf(parts))
        text += fmt::format(",{:.9g},{:.4g}", part.value, part.standard_error);
      text += '\n';
    }
  writeWhole(file, text);
}

void writeMes(const std::string& file, const std::vector<BrfView>& views, const BrfResult& result, const Scene& scene) {
  constexpr double kTurn = 2. * std::numbers::pi;
  std::string text = fmt::format("{}\t5\t-1.000000\n", views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    const ViewDirection& view = views[i].direction;
    double azimuth = std::remainder(view.azimuth - double{scene.sun().azimuth} - std::numbers::pi, kTurn);
    // Below the digits told, the angle that is a whole turn is none.
    if (azimuth < -5e-7) azimuth += kTurn;
    text += fmt::format("{:.6f}\t{:.6f}\t{:.6f}\t{:.6f}\t{:.6f}\n", double{scene.sun().zenith}, view.zenith,
                        std::abs(azimuth), result.views[i].whole.value, result.views[i].whole.standard_error);
  }
  writeWhole(file, text);
}

}  // namespace sunfleck::apps
