#include "leaves/leaf_contents.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "core/require.hpp"

namespace sunfleck {
namespace {

constexpr std::array kContents{
    LeafContent{"structure", "N", "", &LeafContents::structure, 1., 10., 4.},
    LeafContent{"chlorophyll", "Cab", "ug/cm^2", &LeafContents::chlorophyll, 0., 1000., 150.},
    LeafContent{"carotenoids", "Car", "ug/cm^2", &LeafContents::carotenoids, 0., 1000., 50.},
    LeafContent{"anthocyanins", "Ant", "ug/cm^2", &LeafContents::anthocyanins, 0., 1000., 50.},
    LeafContent{"brown_pigments", "Brown", "", &LeafContents::brown_pigments, 0., 100., 5.},
    LeafContent{"water", "Cw", "cm", &LeafContents::water, 0., 10., 0.2},
    LeafContent{"dry_matter", "Cm", "g/cm^2", &LeafContents::dry_matter, 0., 10., 0.1},
    LeafContent{"protein", "Cp", "g/cm^2", &LeafContents::protein, 0., 10., 0.02},
    LeafContent{"carbon_constituents", "CBC", "g/cm^2", &LeafContents::carbon_constituents, 0., 10., 0.1}};

bool hasParts(const LeafContents& leaf) {
  return leaf.protein != 0. || leaf.carbon_constituents != 0.;
}

}  // namespace

std::span<const LeafContent> leafContents() {
  return kContents;
}

const LeafContent& leafContent(std::string_view name, const std::string& where) {
  const auto found = std::ranges::find(kContents, name, &LeafContent::name);
  if (found != kContents.end()) return *found;
  std::string names;
  for (const LeafContent& content : kContents) names += (names.empty() ? "" : ", ") + std::string(content.name);
  throw InvalidInput(fmt::format("{}{}: must be one of: {}", where, name, names));
}

void setContents(LeafContents& leaf, std::span<const std::pair<std::string, double>> values, const std::string& where) {
  std::set<std::string_view> named;
  for (const auto& [name, value] : values) {
    leaf.*leafContent(name, where).value = value;
    if (!named.insert(name).second) throw InvalidInput(fmt::format("{}{}: must be there once", where, name));
  }
  const bool whole = named.contains("dry_matter");
  const bool parts = named.contains("protein") || named.contains("carbon_constituents");
  if (parts && !whole) leaf.dry_matter = 0.;
  if (whole && !parts) leaf.protein = leaf.carbon_constituents = 0.;
  validate(leaf, where);
}

void validate(const LeafContents& leaf, const std::string& where) {
  for (const LeafContent& content : kContents) {
    const double value = leaf.*content.value;
    require(value >= content.low && value <= content.high, where + std::string(content.name), value,
            fmt::format("in [{}, {}]{}{}", content.low, content.high, content.unit.empty() ? "" : " ", content.unit));
  }
  require(leaf.dry_matter == 0. || !hasParts(leaf), where + "dry_matter", leaf.dry_matter,
          "0 beside protein or carbon_constituents, which are that dry matter");
}

}  // namespace sunfleck
