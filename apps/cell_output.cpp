#include "apps/cell_output.hpp"

#include <fmt/format.h>

#include <map>

#include "core/require.hpp"
#include "core/whole_file.hpp"
#include "grid/cell_file.hpp"

namespace sunfleck::apps {
namespace {

std::string csvOf(const TraceCells& cells, std::span<const CellBand> bands) {
  std::string text = "x_m,y_m,z_m,volume_m3";
  std::map<std::size_t, std::vector<const CellAbsorption*>> rows;  // of each cell, by band
  for (std::size_t band = 0; band < bands.size(); ++band) {
    const std::string prefix = bands[band].name.empty() ? "" : bands[band].name + "_";
    for (const char* what : {"leaves", "wood"})
      text += fmt::format(",{0}{1},{0}{1}_standard_error,{0}{1}_per_m", prefix, what);
    for (const CellAbsorption& cell : bands[band].cells) {
      auto& row = rows[cell.cell];
      row.resize(bands.size());
      row[band] = &cell;
    }
  }
  text += '\n';
  for (const auto& [cell, row] : rows) {
    const glm::dvec3 size = cells.size(cell);
    const glm::dvec3 middle = cells.corner() + cells.side() * glm::dvec3(cells.place(cell)) + 0.5 * size;
    const double volume = size.x * size.y * size.z;
    text += fmt::format("{:.9g},{:.9g},{:.9g},{:.9g}", middle.x, middle.y, middle.z, volume);
    for (std::size_t band = 0; band < row.size(); ++band) {
      const CellAbsorption* of = row[band];
      const double per_volume = bands[band].incident_flux / volume;
      for (const Estimate& part : {of ? of->leaves : Estimate(), of ? of->wood : Estimate()})
        text += fmt::format(",{:.9g},{:.4g},{:.9g}", part.value, part.standard_error, part.value * per_volume);
    }
    text += '\n';
  }
  return text;
}

std::vector<CellValues> gridsOf(const TraceCells& cells, std::span<const CellBand> bands) {
  std::vector<CellValues> grids;
  for (const CellBand& band : bands)
    for (const auto& [what, part] : {std::pair{"leaves", &CellAbsorption::leaves}, {"wood", &CellAbsorption::wood}}) {
      const std::string name = fmt::format("absorbed_{}{}{}", what, band.name.empty() ? "" : "_", band.name);
      const std::string description =
          fmt::format("light absorbed by {} per volume, for sun irradiance 1 on a plane that faces the sun", what);
      CellValues values{.name = name, .description = description, .unit = "1/m"};
      CellValues errors{.name = name + "_error", .description = "standard error of " + name, .unit = "1/m"};
      for (const CellAbsorption& cell : band.cells) {
        const Estimate& share = cell.*part;
        if (share.value == 0.) continue;
        const glm::dvec3 size = cells.size(cell.cell);
        const double per_volume = band.incident_flux / (size.x * size.y * size.z);
        for (CellValues* of : {&values, &errors}) of->cells.emplace_back(cells.place(cell.cell));
        values.values.push_back(static_cast<float>(per_volume * share.value));
        errors.values.push_back(static_cast<float>(per_volume * share.standard_error));
      }
      if (values.cells.empty() && what == std::string("wood")) continue;
      grids.push_back(std::move(values));
      grids.push_back(std::move(errors));
    }
  return grids;
}

}  // namespace

void requireCellFile(const std::filesystem::path& file) {
  if (file.extension() != ".csv" && file.extension() != ".vdb")
    throw InvalidInput(file.string() + ": must be named with the extension .csv or .vdb");
  requireWritable(file);
}

void writeCells(const std::filesystem::path& file, const TraceCells& cells, std::span<const CellBand> bands,
                const GridSource& source) {
  if (file.extension() == ".csv")
    writeWhole(file, csvOf(cells, bands));
  else
    writeCellValues(file, gridsOf(cells, bands), cells.corner(), cells.side(), source);
}

}  // namespace sunfleck::apps
