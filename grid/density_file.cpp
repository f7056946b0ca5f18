#include <openvdb/io/io.h>
#include <openvdb/openvdb.h>

#include <algorithm>
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
#include <vector>

#include "core/available_memory.hpp"
#include "core/require.hpp"
#include "grid/density_grid.hpp"
#include "grid/detail/density_cells.hpp"
#include "grid/detail/vdb_layout.hpp"
#include "grid/detail/vdb_seal.hpp"

namespace sunfleck {
namespace fs = std::filesystem;
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

void requireMemory(double bytes) {
  const double most = availableMemory();
  if (bytes <= most) return;
  std::ostringstream why;
  why.precision(3);
  why << "needs more memory than there is: " << bytes * 1e-9 << " GB, of " << most * 1e-9 << " GB";
  throw InvalidInput(why.str());
}

std::string contents(const fs::path& file) {
  std::error_code failure;
  const fs::file_status status = fs::status(file, failure);
  if (status.type() == fs::file_type::not_found) throw InvalidInput("does not exist");
  if (status.type() == fs::file_type::directory) throw InvalidInput("is a folder");
  if (status.type() != fs::file_type::regular) throw InvalidInput("is not a file");
  const std::uintmax_t size = fs::file_size(file, failure);
  if (failure) throw InvalidInput("cannot be read: " + failure.message());
  if (size == 0) throw InvalidInput("is empty");
  requireMemory(static_cast<double>(size));

  std::ifstream in(file, std::ios::binary);
  if (!in) throw InvalidInput(std::string("cannot be read: ") + std::strerror(errno));
  std::string bytes(size, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!in) throw InvalidInput("cannot be read to its end");
  return bytes;
}

constexpr float kAny = std::numeric_limits<float>::max();

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
    for (std::size_t i = 0; i < kOpticsNames.size(); ++i) {
      optics_[i] = findFloatGrid(bytes, kOpticsNames[i]);
      if (optics_[i].has_value() != optics_[0].has_value()) required(bytes, kOpticsNames[optics_[0] ? i : 0]);
    }
    wood_ = findFloatGrid(bytes, kWoodName);
    validateTransforms();
    requireMemory(memory());
    in_.str(std::move(bytes));
  }

  DensityTrees trees() {
    DensityTrees trees;
    trees.density = tree(density_);
    validateValues(*trees.density, "density [1/m]", 0.f, kAny, "finite and not negative");
    if (normals_[0] || optics_[0]) prepareCells(trees);
    if (normals_[0]) readMoments(trees);
    if (optics_[0]) readOptics(trees);
    if (wood_) {
      trees.wood = tree(*wood_);
      validateValues(*trees.wood, "wood [1/m]", 0.f, kAny, "finite and not negative");
    }
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

  // At most, beside the file's bytes: the trees that are kept, one with a moment or optics at a time, and all of these.
  double memory() const {
    double bytes = density_.memory + (wood_ ? wood_->memory : 0.), most = 0.;
    const double cells = density_.memory / sizeof(float);
    for (const auto& moment : normals_) most = std::max(most, moment ? moment->memory : 0.);
    for (const auto& one : optics_) most = std::max(most, one ? one->memory : 0.);
    return bytes + most + (normals_[0] ? cells * sizeof(LeafOrientation) : 0.) +
           (optics_[0] ? cells * sizeof(BandOptics) : 0.);
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
    for (std::size_t i = 0; i < optics_.size(); ++i) same(optics_[i], kOpticsNames[i]);
    same(wood_, kWoodName);
  }

  // Exactly the cells with leaves are active, and blocks are numbered.
  void prepareCells(DensityTrees& trees) {
    auto tile = trees.density->cbeginValueAll();
    tile.setMaxDepth(openvdb::FloatTree::ValueAllCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile)
      if (*tile != 0.f)
        throw InvalidInput(std::string("holds ") +
                           (normals_[0] ? "second moments of leaf normals" : "optics of leaves") +
                           ", and a density whose " + ofCell("block", tile.getCoord()) +
                           " has one value: must have a value for each cell");
    trees.density->getNodes(blocks_);
    for (std::size_t block = 0; block < blocks_.size(); ++block) {
      Leaf& leaf = *blocks_[block];
      for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) leaf.setActiveState(i, leaf.getValue(i) != 0.f);
      leaf.setTransientData(static_cast<openvdb::Index32>(block));
    }
  }

  // `set(values of the cell, value)` of each cell with leaves.
  template <typename Values, typename Set>
  void readInto(std::vector<std::vector<Values>>& of_blocks, const openvdb::FloatTree& one, const Set& set) {
    const openvdb::FloatGrid::ConstAccessor values(one);
    for (std::size_t block = 0; block < blocks_.size(); ++block) {
      auto of_cell = of_blocks[block].begin();
      for (auto cell = blocks_[block]->cbeginValueOn(); cell; ++cell) set(*of_cell++, values.getValue(cell.getCoord()));
    }
  }

  // Throws unless `possible(values)` of each cell with leaves.
  template <typename Values, typename Possible>
  void requirePossible(const std::vector<std::vector<Values>>& of_blocks, const Possible& possible,
                       const std::string& what, const char* rule) const {
    for (std::size_t block = 0; block < blocks_.size(); ++block) {
      auto of_cell = of_blocks[block].begin();
      for (auto cell = blocks_[block]->cbeginValueOn(); cell; ++cell)
        if (!possible(*of_cell++)) throw InvalidInput(ofCell(what, cell.getCoord()) + ": must be " + rule);
    }
  }

  void readMoments(DensityTrees& trees) {
    for (const Leaf* leaf : blocks_) trees.moments.emplace_back(leaf->onVoxelCount());
    for (std::size_t i = 0; i < normals_.size(); ++i) {
      const FloatTreePtr one = tree(*normals_[i]);
      validateValues(*one, kNormalNames[i], -1.f, 1.f, "from -1 to 1");
      readInto(trees.moments, *one, [i](LeafOrientation& of_cell, float value) { of_cell.*kMoments[i] = value; });
    }
    requirePossible(
        trees.moments, [](const LeafOrientation& of_cell) { return of_cell.possible(); },
        "the second moments of leaf normals", "a mean of n n^T over unit vectors n");
  }

  void readOptics(DensityTrees& trees) {
    constexpr float most = 1.f + 0x1p-10f;  // as two that are 1 together may round to in 16 bits
    for (const Leaf* leaf : blocks_) trees.optics.emplace_back(leaf->onVoxelCount());
    for (std::size_t i = 0; i < optics_.size(); ++i) {
      const FloatTreePtr one = tree(*optics_[i]);
      validateValues(*one, kOpticsNames[i], 0.f, 1.f, "from 0 to 1");
      readInto(trees.optics, *one, [i](BandOptics& of_cell, float value) { opticsValue(of_cell, i) = value; });
    }
    requirePossible(
        trees.optics,
        [](const BandOptics& of_cell) {
          return std::all_of(of_cell.begin(), of_cell.end(), [](const LeafOptics& o) { return o.albedo() <= most; });
        },
        "reflectance and transmittance", "at most 1 together");
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
  std::array<std::optional<VdbFloatGrid>, kOpticsNames.size()> optics_;
  std::optional<VdbFloatGrid> wood_;
  std::vector<Leaf*> blocks_;  // of the density, numbered
  std::istringstream in_{std::ios::in | std::ios::binary};
};

}  // namespace

DensityGrid DensityGrid::read(const fs::path& file) {
  initializeOpenVdb();
  try {
    Grids grids(contents(file));
    return DensityGrid(std::make_shared<const Cells>(grids.trees(), grids.cellSize(), grids.corner()));
  } catch (const InvalidInput& wrong) {
    throw InvalidInput(file.string() + ": " + wrong.what());
  } catch (const std::bad_alloc&) {
    throw InvalidInput(file.string() + ": needs more memory than there is");
  } catch (const std::exception& error) {
    throw InvalidInput(file.string() + ": is cut short or corrupt: " + error.what());
  }
}

}  // namespace sunfleck
