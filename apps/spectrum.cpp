#include "apps/spectrum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "apps/csv_rows.hpp"
#include "apps/trace_output.hpp"
#include "core/require.hpp"
#include "core/whole_file.hpp"
#include "render/compare/validation.hpp"

namespace sunfleck::apps {
namespace {

constexpr std::array<std::string_view, 3> kHeaders{
    "name,leaf_reflectance,leaf_transmittance,wood_reflectance,ground_albedo",
    "name,leaf_reflectance,leaf_transmittance,wood_reflectance", "name,leaf_reflectance,leaf_transmittance"};

// The longest that the file begins with.
std::string_view headerOf(const std::string& file) {
  std::ifstream in = openedText(file);
  std::string line;
  std::getline(in, line);
  removeByteOrderMark(line);
  removeReturn(line);
  const auto found = std::find(kHeaders.begin(), kHeaders.end(), line);
  return found == kHeaders.end() ? kHeaders.front() : *found;
}

// Column `column` of a row.
float shareAt(const CsvRow& row, std::string_view header, std::size_t column) {
  const std::string where = fmt::format("{}{}: ", row.where, fieldsOf(header, ",")[column]);
  const double value = numberAt(row.fields[column], where);
  if (!(value >= 0. && value <= 1.))
    throw InvalidInput(fmt::format("{}{}: must be in [0, 1]", where, row.fields[column]));
  return static_cast<float>(value);
}

}  // namespace

Spectrum readSpectrum(const std::string& file, const Scene& scene, int band) {
  const std::string_view header = headerOf(file);
  for (const TreeKind& kind : scene.kinds)
    if (kind.maps) throw InvalidInput("--spectrum: must be for scenes whose leaves are alike everywhere, without maps");
  Spectrum spectrum;
  for (const CsvRow& row : readCsvRows(file, header)) {
    const std::string& name = row.fields[0];
    const std::size_t columns = row.fields.size();
    if (name.empty() || name.size() > 64) throw InvalidInput(row.where + "name: must have 1 to 64 letters");
    if (std::find(spectrum.names.begin(), spectrum.names.end(), name) != spectrum.names.end())
      throw InvalidInput(fmt::format("{}name: {}: must be in one row alone", row.where, name));
    const LeafOptics leaf{.reflectance = shareAt(row, header, 1), .transmittance = shareAt(row, header, 2)};
    if (leaf.reflectance + leaf.transmittance > 1.f)
      throw InvalidInput(
          fmt::format("{}leaf_transmittance: {}: must be at most 1 with the reflectance", row.where, row.fields[2]));
    TraceLight light = traceLight(scene, band);
    for (TreeOptics& tree : light.of_kinds) {
      tree.leaf = leaf;
      if (columns > 3) tree.wood_reflectance = shareAt(row, header, 3);
    }
    if (columns > 4) light.ground_albedo = shareAt(row, header, 4);
    spectrum.names.push_back(name);
    spectrum.bands.push_back(std::move(light));
  }
  if (spectrum.bands.empty()) throw InvalidInput(file + ": must have at least one band");
  return spectrum;
}

void writeSpectrum(const std::string& file, const std::vector<std::string>& names,
                   const std::vector<ForwardResult>& results) {
  std::string text = "name";
  for (const NamedEstimate& figure : figuresOf({})) text += fmt::format(",{0},{0}_standard_error", figure.name);
  text += '\n';
  for (std::size_t band = 0; band < results.size(); ++band) {
    text += names[band];
    for (const NamedEstimate& figure : figuresOf(results[band]))
      text += fmt::format(",{:.9g},{:.4g}", figure.estimate.value, figure.estimate.standard_error);
    text += '\n';
  }
  writeWhole(file, text);
}

}  // namespace sunfleck::apps
