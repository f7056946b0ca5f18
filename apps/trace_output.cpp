#include "apps/trace_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/whole_file.hpp"

namespace sunfleck::apps {
namespace {

using Json = nlohmann::ordered_json;

struct Row {
  const char* name;
  const char* meaning;
  Estimate estimate;
};

std::vector<Row> rowsOf(const ForwardResult& r) {
  std::vector<Row> rows{{"reflected", "back to the sky", r.reflected},
                        {"absorbed_leaves", "absorbed by leaves", r.absorbed_leaves},
                        {"absorbed_wood", "absorbed by wood", r.absorbed_wood},
                        {"arriving_ground", "arriving at the ground", r.arriving_ground},
                        {"arriving_ground_direct", "  without meeting a leaf", r.arriving_ground_direct},
                        {"absorbed_ground", "absorbed by the ground", r.absorbed_ground}};
  if (r.absorbed_particles)
    rows.insert(rows.begin() + 3, {"absorbed_particles", "absorbed by particles", *r.absorbed_particles});
  return rows;
}

// Orders up to the last that any light has.
Json jsonOf(const OrderTable& table) {
  Json values = Json::array(), errors = Json::array();
  int last = OrderTable::kMostOrder;
  while (last > 0 && table.ofOrder(last).value == 0.) --last;
  for (int order = 0; order <= last; ++order) {
    const Estimate share = table.ofOrder(order);
    values.push_back(share.value);
    errors.push_back(share.standard_error);
  }
  return {{"values", values}, {"standard_errors", errors}, {"beyond", table.beyond().value}};
}

}  // namespace

Json known(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

std::vector<NamedEstimate> figuresOf(const ForwardResult& result) {
  std::vector<NamedEstimate> figures;
  for (const Row& row : rowsOf(result)) figures.push_back({row.name, row.estimate});
  return figures;
}

Json jsonOf(const ForwardResult& result) {
  Json json = Json::object();
  for (const Row& row : rowsOf(result)) {
    json[row.name] = row.estimate.value;
    json["standard_errors"][row.name] = row.estimate.standard_error;
  }
  json["sky_share"] = result.sky_share;
  json["orders"] = {{"reflected", jsonOf(result.reflected_by_order)},
                    {"arriving_ground", jsonOf(result.arriving_ground_by_order)}};
  return json;
}

std::string tableOf(const ForwardResult& result) {
  std::string text;
  for (const Row& row : rowsOf(result))
    text += fmt::format("  {:<26} {:.6f} +- {:.6f}\n", row.meaning, row.estimate.value, row.estimate.standard_error);
  if (result.sky_share > 0.) text += fmt::format("  {:<26} {:.6f}\n", "of the light, the sky's", result.sky_share);
  const auto orders = [&](const char* meaning, const OrderTable& table) {
    const Estimate none = table.ofOrder(0), once = table.ofOrder(1);
    double more = table.beyond().value;
    for (int order = 2; order <= OrderTable::kMostOrder; ++order) more += table.ofOrder(order).value;
    text += fmt::format("  {:<26} {:.6f} not, {:.6f} once, {:.6f} more often\n", meaning, none.value, once.value, more);
  };
  orders("sky: scattered by leaves", result.reflected_by_order);
  orders("ground: scattered", result.arriving_ground_by_order);
  return text;
}

std::string tableOf(const ForwardResult& result, const LeafOptics& traced, const LeafOptics& leaf) {
  const Estimate up = result.reflected_by_order.reweighted(traced, leaf);
  const Estimate down = result.arriving_ground_by_order.reweighted(traced, leaf);
  return fmt::format(
      "  leaves of reflectance {} and transmittance {}: {:.6f} +- {:.6f} back to the sky, {:.6f} +- {:.6f} arriving at "
      "the "
      "ground\n",
      leaf.reflectance, leaf.transmittance, up.value, up.standard_error, down.value, down.standard_error);
}

void writeLeaves(const std::string& file, const Scene& scene, const ForwardResult& result) {
  const bool several = scene.kinds.size() > 1;
  std::string text = several ? "kind," : "";
  text +=
      "leaf,area_m2,irradiance,standard_error,front,front_standard_error,back,back_standard_error,direct,"
      "direct_standard_error\n";
  std::size_t i = 0;
  for (const TreeKind& kind : scene.kinds) {
    const std::vector<double> areas = leafAreas(*kind.mesh);
    for (std::size_t leaf = 0; leaf < areas.size(); ++leaf, ++i) {
      if (several) text += kind.name + ",";
      text += fmt::format("{},{:.9g},{:.9g},{:.4g}", leaf, areas[leaf], result.leaf_irradiance[i],
                          result.leaf_standard_error[i]);
      for (const Estimate& part : {result.leaf_front[i], result.leaf_back[i], result.leaf_direct[i]})
        text += fmt::format(",{:.9g},{:.4g}", part.value, part.standard_error);
      text += '\n';
    }
  }
  writeWhole(file, text);
}

}  // namespace sunfleck::apps
