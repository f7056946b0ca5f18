#include <gtest/gtest.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/ChangeBackground.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/random.hpp"
#include "core/require.hpp"
#include "grid/density_grid.hpp"
#include "tests/grid_files.hpp"
#include "tests/random_leaves.hpp"

using namespace sunfleck;

namespace {

// Writes a small grid of floats by OpenVDB alone, after `change`.
void writeOther(const fs::path& file, std::uint32_t compression,
                const std::function<void(openvdb::FloatGrid&)>& change = {}) {
  openvdb::initialize();
  auto grid = openvdb::FloatGrid::create(0.f);
  Random random(3, 0);
  for (int i = 0; i < 300; ++i)
    grid->tree().setValue(openvdb::Coord(int(random.uniform() * 20.f), int(random.uniform() * 9.f), 3),
                          random.uniform());
  grid->setName("density");
  if (change) change(*grid);
  openvdb::io::File out(file.string());
  out.setCompression(compression);
  out.write(openvdb::GridCPtrVec{grid});
  out.close();
}

}  // namespace

// Check that a file read back is the grid that was written, to the bit.
TEST(D1_DensityGridFile, ReadsBackWhatWasWritten) {
  const TemporaryFolder folder;
  const DensityGrid grid = DensityGrid::voxelize(randomLeaves(2000, 1.f, .1f), .1f);
  grid.write(folder / "a.vdb", sourceNamed("random leaves"));
  EXPECT_EQ(folder.files(), 1);
  const DensityGrid read = DensityGrid::read(folder / "a.vdb");
  EXPECT_EQ(sampled(read), sampled(grid));
  EXPECT_EQ(read.leafArea(), grid.leafArea());
  EXPECT_EQ(read.occupiedCells(), grid.occupiedCells());
  EXPECT_EQ(read.cellSize(), grid.cellSize());
  EXPECT_EQ(read.occupied().low, grid.occupied().low);
  EXPECT_EQ(read.occupied().high, grid.occupied().high);
}

// Check what another OpenVDB program finds in the file: name, kind, units, and each cell at its place: the centroid of
// the density is that of the leaves. A leaf may lie half a cell from its cell's centre along each axis, but only the
// mean of these offsets counts: its standard deviation is h / sqrt(12 n) for n leaves, and 5 of them are allowed.
TEST(D1_DensityGridFile, OtherProgramsFindTheLeavesInTheirPlace) {
  const TemporaryFolder folder;
  constexpr int leaves = 2000;
  const float h = 0.4f;
  const TreeMesh mesh = randomLeaves(leaves, 1.f, .05f, {.3f, -2.f, 4.f});
  DensityGrid::voxelize(mesh, h).write(folder / "a.vdb", sourceNamed("these leaves"));

  openvdb::io::File file((folder / "a.vdb").string());
  file.open(false);
  const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("density"));
  EXPECT_EQ(grid->getGridClass(), openvdb::GRID_FOG_VOLUME);
  EXPECT_EQ(grid->metaValue<std::string>("unit_density"), "1/m");
  EXPECT_EQ(grid->metaValue<std::string>("length_unit"), "m");
  EXPECT_EQ(grid->metaValue<std::string>("source"), "these leaves");
  EXPECT_TRUE(grid->getCreator().starts_with("Sunfleck "));
  EXPECT_NEAR(grid->metaValue<double>("leaf_area_m2"), leafArea(mesh), 1e-6 * leafArea(mesh));
  EXPECT_TRUE(grid->transform().isLinear());
  EXPECT_NEAR(grid->transform().voxelSize().y(), static_cast<double>(h), 1e-12);
  EXPECT_NEAR(grid->indexToWorld(openvdb::Coord(0)).x(), static_cast<double>(h) / 2., 1e-12);

  glm::dvec3 of_density(0.), of_leaves(0.);
  double area = 0.;
  for (auto cell = grid->cbeginValueOn(); cell; ++cell) {
    const openvdb::Vec3d centre = grid->indexToWorld(cell.getCoord());
    const double share = static_cast<double>(*cell) * std::pow(static_cast<double>(h), 3);
    of_density += share * glm::dvec3(centre.x(), centre.y(), centre.z());
    area += share;
  }
  for (const glm::uvec3& t : mesh.leaf_triangles)
    of_leaves += triangleArea(mesh, t) * glm::dvec3(mesh.vertices[t.x] + mesh.vertices[t.y] + mesh.vertices[t.z]) / 3. /
                 leafArea(mesh);
  of_density /= area;
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(of_density[axis], of_leaves[axis], 5. * static_cast<double>(h) / std::sqrt(12. * leaves));
}

// Check that files of other programs are read, however they keep their values: all compressions, 16-bit floats, tiles,
// several grids, a transform of another place.
TEST(D1_DensityGridFile, ReadsFilesOfOtherPrograms) {
  openvdb::initialize();
  const TemporaryFolder folder;
  for (const std::uint32_t compression : {0u, 1u, 2u, 3u, 4u, 5u, 6u})
    for (const bool in_half : {false, true}) {
      auto grid = openvdb::FloatGrid::create(0.f);
      Random random(3, 0);
      for (int i = 0; i < 3000; ++i)
        grid->tree().setValue(openvdb::Coord(int(random.uniform() * 90.f) - 60, int(random.uniform() * 20.f),
                                             int(random.uniform() * 9.f)),
                              std::ldexp(1.f, int(random.uniform() * 10.f)));  // exact in 16 bits
      grid->tree().setValueOff(openvdb::Coord(5, 5, 5), 4.f);
      grid->tree().addTile(1, openvdb::Coord(1024, 0, 0), 2.f, true);
      grid->tree().addTile(2, openvdb::Coord(0, 5000, 0), 0.5f, true);
      grid->tree().addTile(3, openvdb::Coord(0, 0, -8192), 0.25f, true);
      grid->setTransform(openvdb::math::Transform::createLinearTransform(0.25));
      grid->transform().postTranslate(openvdb::Vec3d(10., 20., 30.));
      grid->setName("density");
      grid->setSaveFloatAsHalf(in_half);
      auto other = openvdb::Vec3SGrid::create();
      other->tree().setValue(openvdb::Coord(1, 2, 3), openvdb::Vec3s(1.f));
      other->setName("colour");
      openvdb::io::File file((folder / "a.vdb").string());
      file.setCompression(compression);
      file.write(openvdb::GridCPtrVec{other, grid});
      file.close();

      const DensityGrid read = DensityGrid::read(folder / "a.vdb");
      double sum = 0.;
      std::size_t cells = 0;
      for (auto value = grid->tree().cbeginValueAll(); value; ++value)
        if (*value != 0.f) {
          sum += static_cast<double>(*value) * double(value.getVoxelCount());
          cells += value.getVoxelCount();
          const openvdb::Vec3d centre = grid->indexToWorld(value.getCoord());
          ASSERT_EQ(read.at({float(centre.x()), float(centre.y()), float(centre.z())}), *value);
        }
      EXPECT_DOUBLE_EQ(read.leafArea(), sum / 64.) << compression << in_half;
      EXPECT_EQ(read.occupiedCells(), cells);
      EXPECT_EQ(read.occupied().low, glm::vec3(10., 20., 30.) + 0.25f * (glm::vec3(-60.f, 0.f, -8192.f) - 0.5f));
    }
}

// Check that a translation and a scale are understood from every kind of transform that can hold them, and that others
// are refused.
TEST(D1_DensityGridFile, UnderstandsTransforms) {
  const TemporaryFolder folder;
  const fs::path file = folder / "a.vdb";
  const auto with = [&](const openvdb::math::MapBase& map) {
    writeOther(file, 3, [&](openvdb::FloatGrid& grid) {
      grid.setTransform(std::make_shared<openvdb::math::Transform>(map.copy()));
      grid.tree().clear();
      grid.tree().setValue(openvdb::Coord(4, 0, -2), 7.f);
    });
  };
  const openvdb::Vec3d two(2.), moved(.5, 1.5, 2.5);
  with(openvdb::math::ScaleMap(two));
  EXPECT_EQ(DensityGrid::read(file).occupied().low, glm::vec3(7.f, -1.f, -5.f));
  with(openvdb::math::UniformScaleTranslateMap(2., moved));
  EXPECT_EQ(DensityGrid::read(file).occupied().low, glm::vec3(7.5f, .5f, -2.5f));
  with(openvdb::math::ScaleTranslateMap(two, moved));
  EXPECT_EQ(DensityGrid::read(file).occupied().low, glm::vec3(7.5f, .5f, -2.5f));
  with(openvdb::math::TranslationMap(moved));
  EXPECT_EQ(DensityGrid::read(file).occupied().low, glm::vec3(4.f, 1.f, 0.f));
  openvdb::math::Mat4d affine = openvdb::math::Mat4d::identity();
  affine.preScale(two);
  affine.setTranslation(moved);
  with(openvdb::math::AffineMap(affine));
  EXPECT_EQ(DensityGrid::read(file).occupied().low, glm::vec3(7.5f, .5f, -2.5f));

  with(openvdb::math::ScaleMap(openvdb::Vec3d(1., 2., 1.)));
  EXPECT_EQ(refusal(file), file.string() + ": cell size [m] = 2: must be the same along x, y and z");
  affine.preRotate(openvdb::math::Z_AXIS, 0.3);
  with(openvdb::math::AffineMap(affine));
  EXPECT_EQ(refusal(file), file.string() + ": has a grid that is turned or sheared");
  with(openvdb::math::UniformScaleMap(-1.));
  EXPECT_EQ(refusal(file), file.string() + ": cell size [m] = -1: must be from 1e-6 to 1e6");
}

TEST(D1_DensityGridFile, RefusesWhatIsNoDensity) {
  const TemporaryFolder folder;
  const fs::path file = folder / "a.vdb";
  const auto refused = [&](const std::string& why) { EXPECT_EQ(refusal(file), file.string() + ": " + why); };
  refused("does not exist");
  writeBytes(file, "");
  refused("is empty");
  writeBytes(file, "ply\nformat ascii 1.0\n");
  refused("is not a .vdb file");
  EXPECT_EQ(refusal(fs::temp_directory_path()), fs::temp_directory_path().string() + ": is a folder");
  EXPECT_EQ(refusal("/dev/null"), "/dev/null: is not a file");

  const auto with = [&](float value) {
    writeOther(file, 3, [&](openvdb::FloatGrid& grid) { grid.tree().setValue(openvdb::Coord(1, 2, 3), value); });
  };
  with(-1.f);
  refused("density [1/m] of cell [1, 2, 3] = -1: must be finite and not negative");
  with(std::numeric_limits<float>::quiet_NaN());
  refused("density [1/m] of cell [1, 2, 3] = nan: must be finite and not negative");
  with(std::numeric_limits<float>::infinity());
  refused("density [1/m] of cell [1, 2, 3] = inf: must be finite and not negative");
  writeOther(file, 3, [](openvdb::FloatGrid& grid) { openvdb::tools::changeBackground(grid.tree(), 1.f); });
  refused("density [1/m] outside the cells = 1: must be 0");
  writeOther(file, 3, [](openvdb::FloatGrid& grid) { grid.setName("fog"); });
  refused("holds no grid named \"density\"");

  const auto write = [&](const openvdb::GridCPtrVec& grids) { openvdb::io::File(file.string()).write(grids); };
  auto doubles = openvdb::DoubleGrid::create(0.);
  doubles->setName("density");
  write({doubles});
  refused("holds a grid \"density\" that is not of floats");
  auto floats = openvdb::FloatGrid::create(0.f);
  floats->setName("density");
  write({floats, floats->deepCopyGrid()});
  refused("holds more than one grid named \"density\"");
  write({floats});
  EXPECT_EQ(DensityGrid::read(file).leafArea(), 0.);  // an empty grid is a grid
  EXPECT_TRUE(DensityGrid::read(file).occupied().empty());

  EXPECT_THROW(DensityGrid::read(file).write(folder / "none" / "b.vdb", sourceNamed("")), InvalidInput);
  EXPECT_EQ(folder.files(), 1);
}

// Check that a file cut short anywhere is refused: the last byte belongs to the grid.
TEST(D1_DensityGridFile, RefusesATruncatedFile) {
  const TemporaryFolder folder;
  const fs::path file = folder / "a.vdb";
  for (const std::uint32_t compression : {0u, 3u, 6u}) {
    writeOther(file, compression);
    const std::string whole = readBytes(file);
    ASSERT_EQ(refusal(file), "");
    const std::size_t step = std::max<std::size_t>(1, whole.size() / 200);
    for (std::size_t length = 1; length < whole.size();
         length += length < 150 || whole.size() - length < 150 ? 1 : step) {
      writeBytes(file, whole.substr(0, length));
      ASSERT_NE(refusal(file), "") << length << " bytes of " << whole.size();
    }
  }
}

// Check that the same leaves make the same file, and that any one wrong byte in it is found: those after the identifier
// by its checksum, those before it by their rules.
TEST(D1_DensityGridFile, AnyWrongByteInOurOwnFilesIsFound) {
  const TemporaryFolder folder;
  const fs::path file = folder / "a.vdb";
  const TreeMesh mesh = randomLeaves(100, .5f, .1f, glm::vec3(2.f));
  DensityGrid::voxelize(mesh, .1f).write(file, sourceNamed("leaves"));
  const std::string whole = readBytes(file);
  DensityGrid::voxelize(mesh, .1f).write(file, sourceNamed("leaves"));
  EXPECT_EQ(readBytes(file), whole);
  Random random(23, 0);
  for (int repeat = 0; repeat < 100; ++repeat) {
    std::string bytes = whole;
    const std::size_t at = 57 + static_cast<std::size_t>(random.bits() % (whole.size() - 57));
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << (random.bits() % 8)));
    writeBytes(file, bytes);
    ASSERT_NE(refusal(file), "") << "byte " << at;
  }
  for (std::size_t length = 0; length < whole.size(); length += 1 + length / 10) {
    writeBytes(file, whole.substr(0, length));
    ASSERT_NE(refusal(file), "") << length << " bytes";
  }
}

// Check that files with wrong bits, bytes or numbers anywhere are refused or give a sound grid: without a crash, a
// report of the sanitizers, or memory out of proportion to the file.
TEST(D1_DensityGridFile, SurvivesCorruption) {
  const TemporaryFolder folder;
  const fs::path file = folder / "a.vdb";
  Random random(17, 0);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random.bits() % n); };
  for (const std::uint32_t compression : {0u, 1u, 3u, 4u, 6u})
    for (const bool in_half : {false, true}) {
      writeOther(file, compression, [&](openvdb::FloatGrid& grid) { grid.setSaveFloatAsHalf(in_half); });
      const std::string whole = readBytes(file);
      // Masks of empty space fill most of the file; the rest is where damage does most.
      std::vector<std::size_t> not_zero;
      for (std::size_t i = 0; i < whole.size(); ++i)
        if (whole[i] != 0) not_zero.push_back(i);
      for (int repeat = 0; repeat < 60; ++repeat) {
        std::string bytes = whole;
        const std::size_t at = repeat % 3 == 0 ? below(whole.size()) : not_zero[below(not_zero.size())];
        if (repeat % 2 == 0) {
          bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        } else {
          constexpr std::int64_t hostile[] = {-1,
                                              0,
                                              1,
                                              0x7fffffff,
                                              0x80000000,
                                              std::int64_t{1} << 40,
                                              std::numeric_limits<std::int64_t>::max(),
                                              std::numeric_limits<std::int64_t>::min()};
          const std::int64_t number = hostile[below(8)];
          const std::size_t size = std::min(std::size_t{1} << below(4), bytes.size() - at);
          std::memcpy(bytes.data() + at, &number, size);
        }
        writeBytes(file, bytes);
        ASSERT_TRUE(refusedOrSound(file)) << "compression " << compression << ", byte " << at;
      }
    }
}
