#include <openvdb/io/io.h>
#include <openvdb/openvdb.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <exception>
#include <fstream>
#include <glm/common.hpp>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/require.hpp"
#include "grid/density_grid.hpp"
#include "grid/detail/density_cells.hpp"
#include "grid/detail/vdb_layout.hpp"
#include "grid/detail/vdb_seal.hpp"

namespace sunfleck {
namespace fs = std::filesystem;
namespace {

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

// A file that is read: what has been walked of it, and the stream from which OpenVDB may read that.
class Grids {
 public:
  explicit Grids(std::string bytes) {
    checkSeal(bytes);
    density_ = required(bytes, kDensityName);
    for (std::size_t i = 0; i < kNormalNames.size(); ++i) {
      normals_[i] = findFloatGrid(bytes, kNormalNames[i]);
      if (normals_[i].has_value() != normals_[0].has_value())
        required(bytes, kNormalNames[normals_[0] ? i : 0]);  // some without the others mean nothing
    }
    wood_ = findFloatGrid(bytes, kWoodName);
    validateTransforms();
    in_.str(std::move(bytes));
  }

  DensityTrees trees() {
    DensityTrees trees;
    trees.density = tree(density_);
    for (std::size_t i = 0; i < normals_.size(); ++i)
      if (normals_[i]) trees.normals[i] = tree(*normals_[i]);
    if (wood_) trees.wood = tree(*wood_);
    return trees;
  }
  double cellSize() const { return density_.scale.x; }
  glm::dvec3 corner() const { return density_.translation - 0.5 * density_.scale.x; }

 private:
  static VdbFloatGrid required(std::string_view bytes, const char* name) {
    const auto grid = findFloatGrid(bytes, name);
    if (!grid) throw InvalidInput(std::string("holds no grid named \"") + name + "\"");
    return *grid;
  }

  void validateTransforms() const {
    const double side = density_.scale.x;
    require(side >= 1e-6 && side <= 1e6, "cell size [m]", side, "from 1e-6 to 1e6");
    for (int axis = 1; axis < 3; ++axis)
      require(std::abs(density_.scale[axis] - side) <= 1e-6 * side, "cell size [m]", density_.scale[axis],
              "the same along x, y and z");
    for (int axis = 0; axis < 3; ++axis)
      require(std::abs(density_.translation[axis]) <= 1e9, "translation [m]", density_.translation[axis],
              "a finite number of metres, at most 1e9 in size");
    const auto same = [&](const std::optional<VdbFloatGrid>& grid, const char* name) {
      if (grid && !(grid->scale == density_.scale && grid->translation == density_.translation))
        throw InvalidInput(std::string("holds a grid \"") + name + "\" in other cells than those of \"density\"");
    };
    for (std::size_t i = 0; i < normals_.size(); ++i) same(normals_[i], kNormalNames[i]);
    same(wood_, kWoodName);
  }

  // Lets OpenVDB read the tree alone, at a place that has been walked: the rest of its reader trusts the file.
  FloatTreePtr tree(const VdbFloatGrid& grid) {
    in_.exceptions(std::ios::badbit | std::ios::failbit | std::ios::eofbit);
    openvdb::io::setVersion(in_, openvdb::VersionId(grid.library_major, grid.library_minor), grid.file_version);
    openvdb::io::setDataCompression(in_, grid.compression);
    auto made = std::make_shared<openvdb::FloatTree>(0.f);
    in_.seekg(static_cast<std::streamoff>(grid.topology));
    made->readTopology(in_, grid.half);
    in_.seekg(static_cast<std::streamoff>(grid.values));
    made->readBuffers(in_, grid.half);
    return made;
  }

  VdbFloatGrid density_;
  std::array<std::optional<VdbFloatGrid>, kNormalNames.size()> normals_;
  std::optional<VdbFloatGrid> wood_;
  std::istringstream in_{std::ios::in | std::ios::binary};
};

std::string ofCell(const std::string& what, const openvdb::Coord& cell) {
  std::ostringstream where;
  where << what << " of cell " << cell;
  return where.str();
}

// Finite values from `least` to `most`, and 0 outside the cells.
void validateValues(const openvdb::FloatTree& tree, const std::string& what, float least, float most,
                    const char* rule) {
  require(tree.background() == 0.f, what + " outside the cells", tree.background(), "0");
  for (auto value = tree.cbeginValueAll(); value; ++value)
    if (!(std::isfinite(*value) && *value >= least && *value <= most))
      require(false, ofCell(what, value.getCoord()), *value, rule);
}

void validateValues(const DensityTrees& trees) {
  constexpr float any = std::numeric_limits<float>::max();
  validateValues(*trees.density, "density [1/m]", 0.f, any, "finite and not negative");
  if (trees.wood) validateValues(*trees.wood, "wood [1/m]", 0.f, any, "finite and not negative");
  if (!trees.normals[0]) return;
  for (std::size_t i = 0; i < kNormalNames.size(); ++i)
    validateValues(*trees.normals[i], kNormalNames[i], -1.f, 1.f, "from -1 to 1");
  for (auto value = trees.density->cbeginValueAll(); value; ++value) {
    if (*value == 0.f) continue;
    const openvdb::Coord cell = value.getCoord();
    const auto m = [&](std::size_t i) { return trees.normals[i]->getValue(cell); };
    if (!LeafOrientation{m(0), m(1), m(2), m(3), m(4)}.possible())
      throw InvalidInput(ofCell("the second moments of leaf normals", cell) +
                         ": must be a mean of n n^T over unit vectors n");
  }
}

}  // namespace

DensityGrid DensityGrid::read(const fs::path& file) {
  initializeOpenVdb();
  try {
    Grids grids(contents(file));
    DensityTrees trees = grids.trees();
    validateValues(trees);
    return DensityGrid(std::make_shared<const Cells>(std::move(trees), grids.cellSize(), grids.corner()));
  } catch (const InvalidInput& wrong) {
    throw InvalidInput(file.string() + ": " + wrong.what());
  } catch (const std::bad_alloc&) {
    throw InvalidInput(file.string() + ": needs more memory than there is");
  } catch (const std::exception& error) {
    throw InvalidInput(file.string() + ": is cut short or corrupt: " + error.what());
  }
}

}  // namespace sunfleck
