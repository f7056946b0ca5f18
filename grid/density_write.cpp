#include <openvdb/openvdb.h>

#include <cerrno>
#include <cstring>
#include <exception>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>

#include "core/available_memory.hpp"
#include "core/require.hpp"
#include "core/whole_file.hpp"
#include "grid/density_grid.hpp"
#include "grid/detail/density_cells.hpp"
#include "grid/detail/vdb_layout.hpp"
#include "grid/detail/vdb_seal.hpp"
#include "grid/detail/vdb_write.hpp"

namespace sunfleck {
namespace fs = std::filesystem;
namespace {

constexpr const char* kProjection =
    "leaves meet density G(s) lines along s per metre, G(s)^2 = (5 s.M s + 3 |M s|^2) / 8 with M the second moments of "
    "their normals, unit vectors n: exact for leaves of all directions alike and for parallel leaves";

}  // namespace

void writeVdb(const openvdb::GridCPtrVec& grids, const fs::path& file) {
  openvdb::io::File out(file.string());
  out.setCompression(openvdb::io::COMPRESS_ACTIVE_MASK);  // densities of single leaves hardly compress further
  out.write(grids);
  out.close();
  std::ifstream in(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  try {
    for (const auto& grid : grids) findFloatGrid(bytes, grid->getName());
  } catch (const std::exception&) {  // OpenVDB does not tell when the disk is full
    throw std::runtime_error("it did not arrive whole; is the disk full?");
  }
  seal(bytes);
  std::fstream patch(file, std::ios::binary | std::ios::in | std::ios::out);
  patch.write(bytes.data(), static_cast<std::streamsize>(kVdbHeader));
  patch.close();
  if (!patch) throw std::runtime_error(std::strerror(errno));
}

openvdb::GridCPtrVec describedGrids(const DensityGrid::Cells& cells, const GridSource& source) {
  openvdb::GridCPtrVec all;
  for (const DensityGrid::Cells::Named& named : cells.named()) {
    auto grid = openvdb::FloatGrid::create(named.tree());
    auto transform = openvdb::math::Transform::createLinearTransform(cells.cell_size);
    const glm::dvec3 centre = cells.corner + 0.5 * cells.cell_size;  // of cell (0, 0, 0)
    transform->postTranslate(openvdb::Vec3d(centre.x, centre.y, centre.z));
    grid->setTransform(transform);
    grid->setName(named.name);
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->setCreator(source.program);
    const auto text = [&](const std::string& key, const std::string& value) {
      grid->insertMeta(key, openvdb::StringMetadata(value));
    };
    const auto number = [&](const std::string& key, double value) {
      grid->insertMeta(key, openvdb::DoubleMetadata(value));
    };
    text("description", named.description);
    text("unit_" + named.name, named.unit);
    text("length_unit", "m");
    text("source", source.name);
    if (cells.period) {
      number("period_x_m", cells.period->x);
      number("period_y_m", cells.period->y);
    }
    if (!source.hash.empty()) text("source_hash", source.hash);
    if (named.name == kDensityName) {
      number("leaf_area_m2", cells.leaf_area);
      if (cells.crown_area > 0.) {
        number("crown_area_m2", cells.crown_area);
        number("lai", cells.leaf_area / cells.crown_area);
      }
      if (!cells.moments.empty()) text("projection_model", kProjection);
    }
    if (named.name == kWoodName) number("projected_wood_area_m2", cells.wood_area);
    all.push_back(grid);
  }
  return all;
}

void DensityGrid::write(const fs::path& file, const GridSource& source) const {
  initializeOpenVdb();
  // All grids are made to be written, and then the bytes of the file are looked at.
  double bytes = 0.;
  for (const Summary& grid : grids()) bytes += 2. * static_cast<double>(grid.bytes);
  if (const double most = availableMemory(); bytes > most) {
    std::ostringstream why;
    why.precision(3);
    why << file.string() << ": to be written, its grids take " << bytes * 1e-9 << " GB of memory: must be "
        << most * 1e-9 << " GB or less";
    throw InvalidInput(why.str());
  }
  writeWhole(file, [&](const fs::path& temporary) {
    try {
      const openvdb::GridCPtrVec grids = describedGrids(*cells_, source);
      if (file.extension() == ".nvdb")
        writeNanoVdb(grids, temporary);
      else
        writeVdb(grids, temporary);
    } catch (const std::exception& error) {
      throw InvalidInput(file.string() + ": cannot be written: " + error.what());
    }
  });
}

void DensityGrid::writeOver(const fs::path& file) const {
  initializeOpenVdb();
  writeVdb(describedGrids(*cells_, {}), file);
}

}  // namespace sunfleck
