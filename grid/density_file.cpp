#include <openvdb/io/io.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <exception>
#include <fstream>
#include <glm/common.hpp>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>

#include "core/require.hpp"
#include "core/whole_file.hpp"
#include "grid/density_grid.hpp"
#include "grid/detail/density_cells.hpp"
#include "grid/detail/vdb_layout.hpp"
#include "grid/detail/vdb_seal.hpp"

namespace sunfleck {
namespace fs = std::filesystem;
namespace {

constexpr const char* kName = "density";
constexpr std::uintmax_t kLargestFile = std::uintmax_t{1} << 33;  // [byte]

std::string contents(const fs::path& file) {
  std::error_code failure;
  const fs::file_status status = fs::status(file, failure);
  if (status.type() == fs::file_type::not_found) throw InvalidInput("does not exist");
  if (status.type() == fs::file_type::directory) throw InvalidInput("is a folder");
  if (status.type() != fs::file_type::regular) throw InvalidInput("is not a file");
  const std::uintmax_t size = fs::file_size(file, failure);
  if (failure) throw InvalidInput("cannot be read: " + failure.message());
  if (size == 0) throw InvalidInput("is empty");
  if (size > kLargestFile) throw InvalidInput("is larger than 8 GiB");

  std::ifstream in(file, std::ios::binary);
  if (!in) throw InvalidInput(std::string("cannot be read: ") + std::strerror(errno));
  std::string bytes(size, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!in) throw InvalidInput("cannot be read to its end");
  return bytes;
}

// Lets OpenVDB read the tree alone, at a place that has been walked: the rest of its reader trusts the file.
openvdb::FloatTree::Ptr readTree(std::string bytes, const VdbFloatGrid& grid) {
  std::istringstream in(std::move(bytes), std::ios::binary);
  in.exceptions(std::ios::badbit | std::ios::failbit | std::ios::eofbit);
  openvdb::io::setVersion(in, openvdb::VersionId(grid.library_major, grid.library_minor), grid.file_version);
  openvdb::io::setDataCompression(in, grid.compression);
  auto tree = std::make_shared<openvdb::FloatTree>(0.f);
  in.seekg(static_cast<std::streamoff>(grid.topology));
  tree->readTopology(in, grid.half);
  in.seekg(static_cast<std::streamoff>(grid.values));
  tree->readBuffers(in, grid.half);
  return tree;
}

void validateTransform(const VdbFloatGrid& grid) {
  const double side = grid.scale.x;
  require(side >= 1e-6 && side <= 1e6, "cell size [m]", side, "from 1e-6 to 1e6");
  for (int axis = 1; axis < 3; ++axis)
    require(std::abs(grid.scale[axis] - side) <= 1e-6 * side, "cell size [m]", grid.scale[axis],
            "the same along x, y and z");
  for (int axis = 0; axis < 3; ++axis)
    require(std::abs(grid.translation[axis]) <= 1e9, "translation [m]", grid.translation[axis],
            "a finite number of metres, at most 1e9 in size");
}

void validateValues(const openvdb::FloatTree& tree) {
  const auto check = [](float density, const std::string& where) {
    if (!(std::isfinite(density) && density >= 0.f)) require(false, where, density, "finite and not negative");
  };
  require(tree.background() == 0.f, "density [1/m] outside the cells", tree.background(), "0");
  for (auto value = tree.cbeginValueAll(); value; ++value)
    if (!(std::isfinite(*value) && *value >= 0.f)) {
      std::ostringstream where;
      where << "density [1/m] of cell " << value.getCoord();
      check(*value, where.str());
    }
}

openvdb::FloatGrid::Ptr describedGrid(const DensityGrid::Cells& cells, const std::string& source) {
  // The grid of the file is a view of the cells' tree and changes nothing in it.
  auto grid = openvdb::FloatGrid::create(std::const_pointer_cast<openvdb::FloatTree>(cells.tree));
  auto transform = openvdb::math::Transform::createLinearTransform(cells.cell_size);
  const glm::dvec3 centre = cells.corner + 0.5 * cells.cell_size;  // of cell (0, 0, 0)
  transform->postTranslate(openvdb::Vec3d(centre.x, centre.y, centre.z));
  grid->setTransform(transform);
  grid->setName(kName);
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  grid->setCreator(std::string("Sunfleck ") + SUNFLECK_VERSION);
  const auto text = [&](const char* key, const std::string& value) {
    grid->insertMeta(key, openvdb::StringMetadata(value));
  };
  text("description", "one-sided leaf area density: leaf area in a cell over the volume of the cell");
  text("unit_density", "1/m");
  text("length_unit", "m");
  text("source", source);
  grid->insertMeta("leaf_area_m2", openvdb::DoubleMetadata(cells.leaf_area));
  return grid;
}

}  // namespace

void DensityGrid::write(const fs::path& file, const std::string& source) const {
  initializeOpenVdb();
  writeWhole(file, [&](const fs::path& temporary) {
    try {
      openvdb::io::File out(temporary.string());
      out.setCompression(openvdb::io::COMPRESS_ACTIVE_MASK);  // densities of single leaves hardly compress further
      out.write(openvdb::GridCPtrVec{describedGrid(*cells_, source)});
      out.close();
      std::string bytes = contents(temporary);
      try {
        findFloatGrid(bytes, kName);
      } catch (const std::exception&) {  // OpenVDB does not tell when the disk is full
        throw std::runtime_error("it did not arrive whole; is the disk full?");
      }
      seal(bytes);
      std::fstream patch(temporary, std::ios::binary | std::ios::in | std::ios::out);
      patch.write(bytes.data(), static_cast<std::streamsize>(kVdbHeader));
      patch.close();
      if (!patch) throw std::runtime_error(std::strerror(errno));
    } catch (const std::exception& error) {
      throw InvalidInput(file.string() + ": cannot be written: " + error.what());
    }
  });
}

DensityGrid DensityGrid::read(const fs::path& file) {
  initializeOpenVdb();
  try {
    std::string bytes = contents(file);
    checkSeal(bytes);
    const VdbFloatGrid grid = findFloatGrid(bytes, kName);
    validateTransform(grid);
    openvdb::FloatTree::Ptr tree = readTree(std::move(bytes), grid);
    validateValues(*tree);
    return DensityGrid(
        std::make_shared<const Cells>(std::move(tree), grid.scale.x, grid.translation - 0.5 * grid.scale.x));
  } catch (const InvalidInput& wrong) {
    throw InvalidInput(file.string() + ": " + wrong.what());
  } catch (const std::bad_alloc&) {
    throw InvalidInput(file.string() + ": needs more memory than there is");
  } catch (const std::exception& error) {
    throw InvalidInput(file.string() + ": is cut short or corrupt: " + error.what());
  }
}

}  // namespace sunfleck
