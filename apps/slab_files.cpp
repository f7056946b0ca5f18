#include "apps/slab_files.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "apps/number_text.hpp"
#include "core/require.hpp"

namespace sunfleck::apps {
namespace {

constexpr const char* kLayersHeader = "thickness,omega,g";
constexpr std::size_t kMostLines = 10'000;  // far more layers or moments than anyone means

std::ifstream opened(const std::string& file) {
  std::error_code failure;
  std::ifstream in(file);
  if (!in || std::filesystem::is_directory(file, failure)) throw InvalidInput(file + ": cannot be read");
  return in;
}

std::vector<std::string_view> fieldsOf(std::string_view line, std::string_view separators) {
  std::vector<std::string_view> fields;
  for (;;) {
    const std::size_t end = line.find_first_of(separators);
    fields.push_back(line.substr(0, end));
    if (end == std::string_view::npos) return fields;
    line.remove_prefix(end + 1);
  }
}

double numberAt(std::string_view field, const std::string& where) {
  const std::optional<double> value = numberOf(field);
  if (!value) throw InvalidInput(fmt::format("{}\"{}\": must be a number", where, field.substr(0, 40)));
  return *value;
}

// As spreadsheets write it before the first line.
void removeByteOrderMark(std::string& line) {
  if (line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
}

void removeReturn(std::string& line) {
  if (!line.empty() && line.back() == '\r') line.pop_back();
}

}  // namespace

std::vector<pp::Layer> readLayers(const std::string& file) {
  std::ifstream in = opened(file);
  std::vector<pp::Layer> layers;
  std::string line;
  std::getline(in, line);
  removeByteOrderMark(line);
  removeReturn(line);
  if (line != kLayersHeader)
    throw InvalidInput(fmt::format("{}:1: \"{}\": must be {}", file, line.substr(0, 80), kLayersHeader));
  for (std::size_t number = 2; std::getline(in, line); ++number) {
    removeReturn(line);
    if (line.empty()) continue;
    const std::string where = fmt::format("{}:{}: ", file, number);
    if (number > kMostLines) throw InvalidInput(fmt::format("{}must have at most {} lines", where, kMostLines));
    const auto fields = fieldsOf(line, ",");
    if (fields.size() != 3)
      throw InvalidInput(fmt::format("{}{} fields: must be 3, {}", where, fields.size(), kLayersHeader));
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
  std::ifstream in = opened(file);
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
      if (moments.size() >= kMostLines)
        throw InvalidInput(fmt::format("{}must have at most {} moments", where, kMostLines));
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
