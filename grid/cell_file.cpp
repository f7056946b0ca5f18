#include "grid/cell_file.hpp"

#include <openvdb/openvdb.h>

#include "core/require.hpp"
#include "core/whole_file.hpp"
#include "grid/detail/density_cells.hpp"
#include "grid/detail/vdb_write.hpp"

namespace sunfleck {

void writeCellValues(const std::filesystem::path& file, std::span<const CellValues> grids, const glm::dvec3& corner,
                     double cell_size, const GridSource& source) {
  initializeOpenVdb();
  openvdb::GridCPtrVec all;
  for (const CellValues& of : grids) {
    const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0.f);
    openvdb::FloatGrid::Accessor cells = grid->getAccessor();
    for (std::size_t i = 0; i < of.cells.size(); ++i)
      cells.setValue({of.cells[i].x, of.cells[i].y, of.cells[i].z}, of.values[i]);
    auto transform = openvdb::math::Transform::createLinearTransform(cell_size);
    const glm::dvec3 centre = corner + 0.5 * cell_size;  // of cell (0, 0, 0)
    transform->postTranslate(openvdb::Vec3d(centre.x, centre.y, centre.z));
    grid->setTransform(transform);
    grid->setName(of.name);
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->setCreator(source.program);
    const std::pair<std::string, std::string> texts[] = {{"description", of.description},
                                                         {"unit_" + of.name, of.unit},
                                                         {"length_unit", "m"},
                                                         {"source", source.name},
                                                         {"source_hash", source.hash}};
    for (const auto& [key, text] : texts) grid->insertMeta(key, openvdb::StringMetadata(text));
    all.push_back(grid);
  }
  writeWhole(file, [&](const std::filesystem::path& temporary) {
    try {
      writeVdb(all, temporary);
    } catch (const std::exception& error) {
      throw InvalidInput(file.string() + ": cannot be written: " + error.what());
    }
  });
}

}  // namespace sunfleck
