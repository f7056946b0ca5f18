#include <gtest/gtest.h>
#include <nanovdb/util/IO.h>
#include <openvdb/openvdb.h>

#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/random.hpp"
#include "core/require.hpp"
#include "grid/density_grid.hpp"
#include "grid/detail/vdb_layout.hpp"
#include "tests/grid_files.hpp"
#include "tests/random_leaves.hpp"

using namespace sunfleck;

namespace {

const std::vector<std::string> kNames = {"density",   "normal_xx", "normal_yy", "normal_xy",
                                         "normal_xz", "normal_yz", "wood"};

// Leaves and a stick through them, where all coordinates are positive: so they need few of OpenVDB's nodes.
TreeMesh smallTree(int leaves) {
  TreeMesh mesh = randomLeaves(leaves, .5f, .1f, {.9f, .9f, 2.1f});
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {{.9f, .9f, .1f}, {.95f, .9f, .1f}, {.9f, .95f, 3.f}, {.9f, .91f, 3.f}});
  mesh.wood_triangles = {{first, first + 1, first + 2}, {first, first + 2, first + 3}};
  return mesh;
}

// All values at the centres of the cells of side 0.1 of the box that holds the tree.
std::vector<float> allValues(const DensityGrid& grid) {
  std::vector<float> values;
  for (int x = 0; x < 18; ++x)
    for (int y = 0; y < 18; ++y)
      for (int z = 0; z < 32; ++z) {
        const glm::vec3 at = 0.1f * (glm::vec3(x, y, z) + 0.5f);
        const LeafOrientation m = grid.orientationAt(at);
        values.insert(values.end(), {grid.at(at), m.xx, m.yy, m.xy, m.xz, m.yz, grid.woodAt(at)});
      }
  return values;
}

// In the order of kNames; OpenVDB hands grids out in that of their names.
std::vector<openvdb::FloatGrid::Ptr> readByOpenVdb(const fs::path& path) {
  openvdb::initialize();
  openvdb::io::File file(path.string());
  file.open(false);
  std::vector<openvdb::FloatGrid::Ptr> grids;
  for (const std::string& name : kNames) grids.push_back(openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid(name)));
  EXPECT_EQ(file.getGrids()->size(), kNames.size());
  return grids;
}

// Writes our file anew by OpenVDB, after `change`: it carries no seal of ours then.
void rewrite(const fs::path& file, const std::function<void(std::vector<openvdb::GridBase::Ptr>&)>& change) {
  std::vector<openvdb::GridBase::Ptr> grids;
  for (const auto& grid : readByOpenVdb(file)) grids.push_back(grid);
  change(grids);
  openvdb::io::File(file.string()).write(openvdb::GridPtrVec(grids.begin(), grids.end()));
}

}  // namespace

// Check that all grids are read back as they were written, to the bit, also when another program has written them anew.
TEST(D7_GridFile, ReadsBackAllGrids) {
  const TemporaryFolder folder;
  const DensityGrid grid = DensityGrid::voxelize(smallTree(500), .1f);
  grid.write(folder / "a.vdb", sourceNamed("a tree"));
  EXPECT_EQ(allValues(DensityGrid::read(folder / "a.vdb")), allValues(grid));
  rewrite(folder / "a.vdb", [](auto&) {});
  const DensityGrid read = DensityGrid::read(folder / "a.vdb");
  EXPECT_EQ(allValues(read), allValues(grid));
  EXPECT_EQ(read.projectedLeafArea({0.f, 0.f, 1.f}), grid.projectedLeafArea({0.f, 0.f, 1.f}));
  EXPECT_EQ(read.projectedWoodArea(), grid.projectedWoodArea());
  EXPECT_EQ(read.crownArea(), grid.crownArea());
  EXPECT_EQ(read.grids().size(), kNames.size());
}

// Check what OpenVDB's own reader finds: the grids in their order, in the same cells, of the same kind, with units and
// origin; the moments where there is density.
TEST(D7_GridFile, OtherProgramsFindAllGrids) {
  const TemporaryFolder folder;
  const TreeMesh mesh = smallTree(500);
  const DensityGrid made = DensityGrid::voxelize(mesh, .1f);
  made.write(folder / "a.vdb", {.name = "a tree", .hash = meshHash(mesh), .program = "Sunfleck 1, commit 2"});
  const auto grids = readByOpenVdb(folder / "a.vdb");
  const std::string bytes = readBytes(folder / "a.vdb");
  std::size_t place = 0;
  for (std::size_t i = 0; i < grids.size(); ++i) {
    const std::size_t next = bytes.find(kNames[i] + std::string("\x10\0\0\0Tree_float", 14));
    ASSERT_TRUE(next > place && next != std::string::npos) << kNames[i];
    place = next;
    const openvdb::FloatGrid& grid = *grids[i];
    EXPECT_EQ(grid.getGridClass(), openvdb::GRID_FOG_VOLUME);
    EXPECT_TRUE(grid.transform() == grids[0]->transform());
    EXPECT_EQ(grid.metaValue<std::string>("unit_" + kNames[i]), i == 0 || i == 6 ? "1/m" : "1");
    EXPECT_EQ(grid.metaValue<std::string>("source_hash"), meshHash(mesh));
    EXPECT_EQ(grid.getCreator(), "Sunfleck 1, commit 2");
    EXPECT_TRUE(i == 6 || grid.tree().hasSameTopology(grids[0]->tree()));
    for (auto cell = grid.cbeginValueOn(); cell; ++cell) {
      const openvdb::Vec3d at = grid.indexToWorld(cell.getCoord());
      const glm::vec3 centre(static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(at.z()));
      const LeafOrientation m = made.orientationAt(centre);
      ASSERT_EQ(*cell, (std::vector{made.at(centre), m.xx, m.yy, m.xy, m.xz, m.yz, made.woodAt(centre)}[i]));
    }
  }
  EXPECT_DOUBLE_EQ(grids[0]->metaValue<double>("lai"), made.leafArea() / made.crownArea());
  EXPECT_NE(grids[0]->metaValue<std::string>("projection_model").find("(5 s.M s + 3 |M s|^2) / 8"), std::string::npos);
  EXPECT_DOUBLE_EQ(grids[6]->metaValue<double>("projected_wood_area_m2"), made.projectedWoodArea());
}

// Check that the mesh's hash tells meshes apart, by places and by what is leaf and what wood.
TEST(D7_GridFile, HashTellsMeshesApart) {
  const TreeMesh mesh = smallTree(10);
  TreeMesh moved = mesh, other = mesh;
  moved.vertices[3].x += 1e-6f;
  std::swap(other.leaf_triangles, other.wood_triangles);
  EXPECT_EQ(meshHash(mesh), meshHash(smallTree(10)));
  EXPECT_NE(meshHash(mesh), meshHash(moved));
  EXPECT_NE(meshHash(mesh), meshHash(other));
}

// Check that the crown's area counts columns of cells once, however many of their cells hold leaves.
TEST(D7_GridFile, CrownAreaCountsColumns) {
  TreeMesh mesh;
  for (const float z : {.5f, 1.5f, 9.5f}) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {{.1f, .1f, z}, {1.9f, .1f, z}, {.1f, .9f, z}});
    mesh.leaf_triangles.push_back({first, first + 1, first + 2});
  }
  finish(mesh, "three leaves");
  EXPECT_DOUBLE_EQ(DensityGrid::voxelize(mesh, 1.f).crownArea(), 2.);
}

// Check that NanoVDB's reader finds the same grids with the same values in the same cells, and that equal grids make
// equal files.
TEST(D7_GridFile, NanoVdbHoldsTheSame) {
  const TemporaryFolder folder;
  const DensityGrid made = DensityGrid::voxelize(smallTree(500), .1f);
  made.write(folder / "a.vdb", sourceNamed("a tree"));
  made.write(folder / "a.nvdb", sourceNamed("a tree"));
  made.write(folder / "b.nvdb", sourceNamed("a tree"));
  EXPECT_EQ(folder.files(), 3);
  EXPECT_EQ(readBytes(folder / "a.nvdb"), readBytes(folder / "b.nvdb"));
  const auto grids = readByOpenVdb(folder / "a.vdb");
  const auto handles = nanovdb::io::readGrids((folder / "a.nvdb").string());
  ASSERT_EQ(handles.size(), grids.size());
  for (std::size_t i = 0; i < grids.size(); ++i) {
    const nanovdb::FloatGrid* nano = handles[i].grid<float>();
    ASSERT_NE(nano, nullptr);
    EXPECT_EQ(nano->gridName(), kNames[i]);
    EXPECT_TRUE(nano->isFogVolume());
    EXPECT_EQ(nano->activeVoxelCount(), grids[i]->activeVoxelCount());
    const auto bounds = grids[i]->evalActiveVoxelBoundingBox();
    for (auto cell = bounds.begin(); cell; ++cell)
      ASSERT_EQ(nano->tree().getValue(nanovdb::Coord((*cell).x(), (*cell).y(), (*cell).z())),
                grids[i]->tree().getValue(*cell));
    const openvdb::Vec3d expected = grids[i]->indexToWorld(openvdb::Coord(3, -4, 5));
    const nanovdb::Vec3d found = nano->indexToWorld(nanovdb::Vec3d(3., -4., 5.));
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(found[axis], expected[axis], 1e-12);
  }
  EXPECT_THROW(made.write(folder / "none" / "b.nvdb", sourceNamed("")), InvalidInput);
  EXPECT_THROW(made.write("/dev/full", sourceNamed("")), InvalidInput);
}

// Check that the memory foretold from a file's bytes is what OpenVDB takes: of blocks, of nodes almost empty, of tiles.
// Left out are the tree itself and its root, a kilobyte; the root's entries count with what an allocator adds: 1 %.
TEST(D7_GridFile, MemoryIsForetold) {
  const TemporaryFolder folder;
  const fs::path file = folder / "a.vdb";
  for (const int far : {0, 100}) {
    DensityGrid::voxelize(smallTree(500), .1f).write(file, sourceNamed("a tree"));
    rewrite(file, [&](std::vector<openvdb::GridBase::Ptr>& grids) {
      grids.resize(1);
      auto& tree = openvdb::gridPtrCast<openvdb::FloatGrid>(grids[0])->tree();
      for (int i = 0; i < far; ++i) tree.setValue(openvdb::Coord(4096 * i, 0, 0), 1.f);
      for (int i = 0; i < far; ++i) tree.addTile(3, openvdb::Coord(0, 0, 4096 * (i + 1)), 1.f, true);
    });
    openvdb::io::File reader(file.string());
    reader.open(false);
    const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(reader.readGrid("density"));
    const auto taken = static_cast<double>(grid->tree().memUsage());
    const double foretold = findFloatGrid(readBytes(file), "density")->memory;
    EXPECT_NEAR(foretold / taken, 1., 0.01);
  }
}

TEST(D7_GridFile, RefusesGridsThatDoNotBelongTogether) {
  const TemporaryFolder folder;
  const fs::path file = folder / "a.vdb";
  const auto refused = [&](const std::string& why, const auto& change) {
    DensityGrid::voxelize(smallTree(20), .1f).write(file, sourceNamed("a tree"));
    rewrite(file, change);
    EXPECT_EQ(refusal(file), why.empty() ? "" : file.string() + ": " + why);
  };
  using Grids = std::vector<openvdb::GridBase::Ptr>;
  const auto floats = [](Grids& grids, std::size_t i) { return openvdb::gridPtrCast<openvdb::FloatGrid>(grids[i]); };
  refused("", [](Grids& grids) { grids.resize(1); });
  refused("holds no grid named \"density\"", [](Grids& grids) { grids.erase(grids.begin()); });
  refused("holds no grid named \"normal_xx\"", [](Grids& grids) { grids.erase(grids.begin() + 1); });
  refused("holds no grid named \"normal_yz\"", [](Grids& grids) { grids.erase(grids.begin() + 5); });
  refused("holds a grid \"normal_xy\" in other cells than those of \"density\"",
          [](Grids& grids) { grids[3]->transform().postTranslate(openvdb::Vec3d(.1, 0., 0.)); });
  refused("holds a grid \"wood\" in other cells than those of \"density\"",
          [](Grids& grids) { grids[6]->setTransform(openvdb::math::Transform::createLinearTransform(.2)); });
  refused("holds a grid \"wood\" that is not of floats", [](Grids& grids) {
    grids[6] = openvdb::DoubleGrid::create(0.);
    grids[6]->setName("wood");
  });
  refused("wood [1/m] of cell [1, 2, 3] = -1: must be finite and not negative",
          [&](Grids& grids) { floats(grids, 6)->tree().setValue(openvdb::Coord(1, 2, 3), -1.f); });
  refused("normal_xz of cell [1, 2, 3] = nan: must be from -1 to 1", [&](Grids& grids) {
    floats(grids, 4)->tree().setValue(openvdb::Coord(1, 2, 3), std::numeric_limits<float>::quiet_NaN());
  });
  refused("the second moments of leaf normals of cell [0, 0, 0]: must be a mean of n n^T over unit vectors n",
          [&](Grids& grids) {
            floats(grids, 0)->tree().clear();
            floats(grids, 0)->tree().setValue(openvdb::Coord(0, 0, 0), 1.f);
            floats(grids, 1)->tree().setValue(openvdb::Coord(0, 0, 0), .9f);
            floats(grids, 2)->tree().setValue(openvdb::Coord(0, 0, 0), .9f);
          });
}

// Check 1,200 damaged files of several grids. As we wrote them, they are refused or hold the same values: the checksum
// finds the damage, unless it is in the identifier, without which the rest is whole. Under another identifier, as if
// another program had written them, they are refused with one line or sound.
TEST(D7_GridFile, DamageIsRefusedOrHarmless) {
  const TemporaryFolder folder;
  const fs::path file = folder / "a.vdb";
  const DensityGrid grid = DensityGrid::voxelize(smallTree(4), .1f);
  grid.write(file, sourceNamed("a tree"));
  const std::string ours = readBytes(file);
  const std::vector<float> values = allValues(grid);
  std::string foreign = ours;
  foreign.replace(21, 36, "01234567-89ab-4def-8123-456789abcdef");
  Random random(29, 0);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random.bits() % n); };
  // Masks of empty space fill most of the file; the rest is where damage does most.
  std::vector<std::size_t> not_zero;
  for (std::size_t i = 0; i < ours.size(); ++i)
    if (ours[i] != 0) not_zero.push_back(i);
  int refused = 0;
  for (int repeat = 0; repeat < 1200; ++repeat) {
    const bool sealed = repeat % 4 != 0;
    const std::string& whole = sealed ? ours : foreign;
    std::string bytes = whole;
    const std::size_t at = repeat % 3 == 0 ? below(bytes.size()) : not_zero[below(not_zero.size())];
    const std::size_t other = below(bytes.size());
    switch (repeat / 4 % 5) {
      case 0:
      case 1:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
      case 2: {
        const std::uint64_t number =
            std::vector<std::uint64_t>{0, 1, ~0ull, 1ull << 31, 1ull << 40, 1ull << 63}[below(6)];
        std::memcpy(bytes.data() + at, &number, std::min(std::size_t{1} << below(4), bytes.size() - at));
        break;
      }
      case 3:
        bytes.resize(other);
        break;
      case 4:
        bytes.erase(at, 1 + below(16));
        break;
    }
    if (bytes == whole) continue;
    writeBytes(file, bytes);
    if (!sealed) {
      ASSERT_TRUE(refusedOrSound(file)) << "byte " << at;
    } else if (refusal(file).empty()) {
      ASSERT_EQ(allValues(DensityGrid::read(file)), values) << "byte " << at;
    } else {
      ++refused;
    }
  }
  EXPECT_GT(refused, 850);  // of 900, but for those in the identifier and those that changed nothing
}
