#include "apps/leaf_tissue.hpp"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <set>
#include <span>

#include "apps/leaf_options.hpp"
#include "core/require.hpp"
#include "leaves/slab_leaf.hpp"

namespace sunfleck::apps {
namespace {

struct NamedValue {
  const char* name;
  double* value;
};

// Sets the values that `text` names, each at most once; the first `needed` of them must be there.
void read(const std::string& text, const std::string& option, std::span<const NamedValue> values, std::size_t needed) {
  std::set<std::string> named;
  for (const auto& [name, number] : namedNumbers(text, option)) {
    double* value = nullptr;
    std::string names;
    for (const NamedValue& each : values) {
      if (name == each.name) value = each.value;
      names += (names.empty() ? "" : ", ") + std::string(each.name);
    }
    if (!value) throw InvalidInput(fmt::format("{}: {}: must be one of: {}", option, name, names));
    if (!named.insert(name).second) throw InvalidInput(fmt::format("{}: {}: must be there once", option, name));
    *value = number;
  }
  for (const NamedValue& each : values.first(needed))
    if (!named.contains(each.name)) throw InvalidInput(fmt::format("{}: {}: must be told", option, each.name));
}

std::string report(const LeafTissue& tissue, const TissueFit* fit, bool json) {
  const SlabLeaf leaf = slabLeaf(tissue);
  if (json) {
    nlohmann::ordered_json all{{"tissue",
                                {{"absorption_per_mm", tissue.absorption},
                                 {"scattering_per_mm", tissue.scattering},
                                 {"thickness_mm", tissue.thickness},
                                 {"optical_thickness", tissue.opticalThickness()}}},
                               {"reflectance", leaf.sides.reflectance},
                               {"transmittance", leaf.sides.transmittance},
                               {"direct", leaf.direct},
                               {"absorptance", leaf.absorptance},
                               {"A", leaf.a},
                               {"B", leaf.b}};
    if (fit) all["residual"] = fit->residual;
    return all.dump(2) + "\n";
  }
  std::string text = "Slab of leaf tissue, lit upright, on black ground\n\n";
  const auto line = [&](const char* name, double value, const char* unit) {
    text += fmt::format("  {:<20} {:>12.6g}{}{}\n", name, value, *unit ? " " : "", unit);
  };
  line("absorption", tissue.absorption, "1/mm");
  line("scattering", tissue.scattering, "1/mm");
  line("thickness", tissue.thickness, "mm");
  line("optical thickness", tissue.opticalThickness(), "");
  if (fit) line("residual", fit->residual, "");
  text += "\n";
  line("reflectance", leaf.sides.reflectance, "");
  line("transmittance", leaf.sides.transmittance, "");
  line("  direct light", leaf.direct, "");
  line("absorptance", leaf.absorptance, "");
  line("A", leaf.a, "(reflectance = A omega / 2)");
  line("B", leaf.b, "(transmittance = direct + B omega / 2)");
  return text;
}

}  // namespace

std::string tissueReport(const std::string& tissue, bool json) {
  LeafTissue told;
  const std::array values{NamedValue{"absorption", &told.absorption}, NamedValue{"scattering", &told.scattering},
                          NamedValue{"thickness", &told.thickness}};
  read(tissue, "--tissue", values, values.size());
  validate(told, "--tissue: ");
  return report(told, nullptr, json);
}

std::string sidesReport(const std::string& sides, bool json) {
  LeafSides told;
  double thickness = LeafTissue{}.thickness;
  const std::array values{NamedValue{"reflectance", &told.reflectance},
                          NamedValue{"transmittance", &told.transmittance}, NamedValue{"thickness", &thickness}};
  read(sides, "--sides", values, 2);
  try {
    const TissueFit fit = tissueOf(std::span(&told, 1), thickness).front();
    return report(fit.tissue, &fit, json);
  } catch (const InvalidInput& e) {
    throw InvalidInput(std::string("--sides: ") + e.what());
  }
}

}  // namespace sunfleck::apps
