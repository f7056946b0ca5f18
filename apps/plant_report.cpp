#include "apps/plant_report.hpp"

#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>

#include "grid/deep_opacity_map.hpp"
#include "grid/leaf_depth.hpp"
#include "plants/leaf_inclination.hpp"

namespace sunfleck::apps {

PlantReport::PlantReport(const TreeMesh& mesh, std::string source, std::string how, const Dropped& dropped,
                         const CardAreas& cards)
    : mesh_(mesh),
      source_(std::move(source)),
      how_(std::move(how)),
      dropped_(dropped),
      cards_(cards),
      area_(sunfleck::leafArea(mesh)) {
  const DeepOpacityMap overhead(mesh, {0.f, 0.f, -1.f}, 512);
  std::size_t covered = 0;
  for (std::size_t pixel = 0; pixel + 1 < overhead.first().size(); ++pixel)
    covered += overhead.first()[pixel + 1] > overhead.first()[pixel];
  const LeafDepths depths = leafDepths(mesh, overhead).front();
  const auto mean = [](const std::vector<float>& v) {
    return std::accumulate(v.begin(), v.end(), 0.) / static_cast<double>(v.size());
  };
  const auto pixel = static_cast<double>(overhead.pixelSize());
  const double projected = static_cast<double>(covered) * pixel * pixel;  // of the crown on the ground [m^2]
  // Leaves that are all upright cover nothing from above: there is no index then.
  lai_ = projected > 0. ? area_ / projected : 0.;
  mean_depth_ = mean(depths.depth);
  mean_thickness_ = mean(depths.thickness);
}

nlohmann::ordered_json PlantReport::json() const {
  const LeafInclination lean = leafInclination(mesh_);
  nlohmann::ordered_json all{{"leaves", mesh_.leaf_count},
                             {"leaf_triangles", mesh_.leaf_triangles.size()},
                             {"leaf_area_m2", area_},
                             {"wood_triangles", mesh_.wood_triangles.size()},
                             {"lai", lai_},
                             {"units", "m"},
                             {"mean_depth", mean_depth_},
                             {"mean_thickness", mean_thickness_},
                             {"dropped_leaf_triangles", dropped_.leaf_triangles},
                             {"dropped_wood_triangles", dropped_.wood_triangles},
                             {"leaf_angle_shares", lean.shares},
                             {"mean_leaf_angle_deg", lean.mean_angle * 180. / std::numbers::pi}};
  if (dropped_.doubled > 0) all["doubled_leaf_triangles"] = dropped_.doubled;
  if (cards_.before > 0.) all["cards"] = {{"area_before_m2", cards_.before}, {"area_after_m2", cards_.after}};
  return all;
}

std::string PlantReport::text() const {
  std::string text = source_ + "\n";
  const auto line = [&]<typename... Values>(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(text), format, std::forward<Values>(values)...);
  };
  const glm::vec3 size = bounds(mesh_).size();
  if (!how_.empty()) line("  leaf and wood  {}\n", how_);
  line("  leaves         {} ({} triangles), {:.4g} m2 of one side\n", mesh_.leaf_count, mesh_.leaf_triangles.size(),
       area_);
  line("  wood           {} triangles\n", mesh_.wood_triangles.size());
  if (dropped_.leaf_triangles + dropped_.wood_triangles > 0)
    line("  dropped        {} leaf and {} wood triangles of no area\n", dropped_.leaf_triangles,
         dropped_.wood_triangles);
  if (dropped_.doubled > 0)
    line("  doubled        {} leaf triangles that the file holds twice count once\n", dropped_.doubled);
  if (cards_.before > 0.)
    line("  cards          {:.4g} m2 before, {:.4g} m2 of leaf after: {:.3g} %\n", cards_.before, cards_.after,
         100. * cards_.after / cards_.before);
  line("  size           {:.3g} x {:.3g} x {:.3g} m\n", size.x, size.y, size.z);
  line("  leaf area      {:.3g} times the crown's projection on the ground\n", lai_);
  line("  from overhead  a leaf lies {:.2f} leaves deep in {:.2f} on average\n", mean_depth_, mean_thickness_);
  const LeafInclination lean = leafInclination(mesh_);
  const auto spherical = sphericalShares();
  line(
      "  leaf angles    {:.1f} degrees from the vertical to the normal on average; shares, and those of all directions "
      "alike\n",
      lean.mean_angle * 180. / std::numbers::pi);
  constexpr double kPercentPerMark = 0.01;
  for (std::size_t i = 0; i < lean.shares.size(); ++i)
    line("    {:2} to {:2}     {:5.1f} %  {:5.1f} %  {}\n", 10 * i, 10 * i + 10, 100. * lean.shares[i],
         100. * spherical[i], std::string(static_cast<std::size_t>(lean.shares[i] / kPercentPerMark + 0.5), '*'));
  return text;
}

}  // namespace sunfleck::apps
