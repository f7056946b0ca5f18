#include "apps/slab_files.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <fstream>

#include "apps/csv_rows.hpp"
#include "core/require.hpp"

namespace sunfleck::apps {
namespace {

constexpr const char* kLayersHeader = "thickness,omega,g";

}  // namespace

std::vector<pp::Layer> readLayers(const std::string& file) {
  std::vector<pp::Layer> layers;
  for (const auto& [where, fields] : readCsvRows(file, kLayersHeader)) {
    std::array<double, 3> values{};
    for (std::size_t i = 0; i < 3; ++i) values[i] = numberAt(fields[i], where);
    const auto [thickness, albedo, asymmetry] = values;
    require(thickness > 0., where + "thickness", thickness, "above 0; inf is allowed in the last layer");
    require(albedo >= 0. && albedo <= 1., where + "omega", albedo, "in [0, 1]");
    require(asymmetry > -1. && asymmetry < 1., where + "g", asymmetry, "in (-1, 1)");
    if (!layers.empty() && std::isinf(layers.back().thickness))
      throw InvalidInput(where + "a layer below one of infinite thickness: only the last may be infinite");
    layers.push_back({.thickness = thickness,
                      .medium = Particles{.albedo = albedo, .phase = PhaseFunction::henyeyGreenstein(asymmetry)}});
  }
  if (layers.empty()) throw InvalidInput(file + ": must have at least one layer");
  return layers;
}

PhaseFunction readMoments(const std::string& file) {
  std::ifstream in = openedText(file);
  std::vector<double> moments;
  std::string line;
  for (std::size_t number = 1; std::getline(in, line); ++number) {
    if (number == 1) removeByteOrderMark(line);
    removeReturn(line);
    for (const std::string_view field : fieldsOf(line, ", \t")) {
      if (field.empty()) continue;
      const std::string where = fmt::format("{}:{}: ", file, number);
      const double moment = numberAt(field, where);
      require(std::abs(moment) <= 1., fmt::format("{}chi_{}", where, moments.size()), moment, "in (-1, 1), chi_0 = 1");
      if (moments.size() >= kMostTextLines)
        throw InvalidInput(fmt::format("{}must have at most {} moments", where, kMostTextLines));
      moments.push_back(moment);
    }
  }
  if (moments.empty()) throw InvalidInput(file + ": must hold at least one moment, chi_0 = 1");
  try {
    return PhaseFunction::fromMoments(std::move(moments));
  } catch (const InvalidInput& e) {
    throw InvalidInput(file + ": " + e.what());
  }
}

}  // namespace sunfleck::apps
