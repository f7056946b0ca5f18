#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "grid/density_grid.hpp"
#include "render/reference/forward_trace.hpp"

namespace sunfleck::apps {

// Light absorbed in the cells of one band.
struct CellBand {
  std::string name;  // empty where there is one band alone
  std::vector<CellAbsorption> cells;
  double incident_flux = 0.;  // that their shares are of [m^2]
};

// Throws InvalidInput unless the file is one to write cells into: .csv or .vdb.
void requireCellFile(const std::filesystem::path& file);

// Writes what each cell absorbs. As .csv: a row for each cell that absorbs anything, with its middle, its volume and,
// for each band, shares of the incident light and their standard errors. As .vdb: absorbed light per volume, for sun
// irradiance 1 on a plane that faces the sun [1/m], and its standard errors.
void writeCells(const std::filesystem::path& file, const TraceCells& cells, std::span<const CellBand> bands,
                const GridSource& source);

}  // namespace sunfleck::apps
