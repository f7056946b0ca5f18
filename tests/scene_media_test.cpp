// Check that the leaves of a scene become a medium that holds as many of them, turned as they are, where they are.
#include "render/compare/scene_media.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/require.hpp"
#include "grid/density_grid.hpp"
#include "render/reference/detail/leaf_normals.hpp"
#include "scattering/leaf_angles.hpp"
#include "tests/leaf_shapes.hpp"

using namespace sunfleck;
using namespace sunfleck::shapes;

namespace {

Scene sceneOf(TreeMesh mesh) {
  Scene scene;
  scene.kinds[0].mesh = std::make_shared<const TreeMesh>(std::move(mesh));
  return scene;
}

double volumeOf(const MediumVoxels& voxels) {
  return std::pow(static_cast<double>(voxels.cell_size), 3);
}

}  // namespace

// Check that the cells of a medium are those of the grid: what they hold, where, and how it is turned (D8), to some
// roundings.
TEST(R15_SceneMedia, CellsAreThoseOfTheGrid) {
  const DensityGrid grid = DensityGrid::voxelize(leafBox(80, 3), 0.15f);
  const MediumVoxels voxels = mediumVoxels(grid, 2.f, true);
  ASSERT_EQ(voxels.density.size(), voxels.blocks.size() * MediumVoxels::kCells);
  ASSERT_EQ(voxels.leaves.size(), voxels.density.size());
  EXPECT_TRUE(mediumVoxels(grid, 1.f, false).leaves.empty());
  Random random(2, 0);
  double sum = 0.;
  std::size_t occupied_cells = 0;
  for (std::size_t i = 0; i < voxels.density.size(); ++i) {
    sum += static_cast<double>(voxels.density[i]) * volumeOf(voxels) / 2.;
    const int in_block = static_cast<int>(i % MediumVoxels::kCells);
    const glm::ivec3 cell = MediumVoxels::kSide * voxels.blocks[i / MediumVoxels::kCells] +
                            glm::ivec3(in_block / 64, in_block / 8 % 8, in_block % 8);
    const glm::vec3 centre = voxels.corner + voxels.cell_size * (glm::vec3(cell) + 0.5f);
    EXPECT_EQ(voxels.density[i], 2.f * grid.at(centre));
    if (voxels.density[i] == 0.f) continue;
    ++occupied_cells;
    const glm::vec3 s = onSphere(random);
    EXPECT_NEAR(glm::length(detail::LeafEllipsoid(voxels.leaves[i], 1.f).seen(s)),
                grid.orientationAt(centre).projection(s), 3e-4f);  // as a root makes 1e-4 of a rounding of 1e-8
  }
  EXPECT_EQ(occupied_cells, grid.occupiedCells());
  EXPECT_NEAR(sum, grid.leafArea(), 1e-5 * sum);
}

// Check that a turbid scene has the wood of the scene, no leaf, the optics of its leaves and all their area, in the
// same box, alone and in a periodic stand of turned trees; and that a flat leaf is taken too.
TEST(R15_SceneMedia, TurbidSceneKeepsWoodAreaAndBox) {
  TreeMesh mesh = leafBox(50, 7);
  const double area = leafArea(mesh);
  addPolygon(mesh, mesh.wood_triangles, rectangle({0.f, 0.f, 0.f}, {0.1f, 0.f, 0.f}, {0.f, 0.f, 0.3f}));
  finish(mesh, "tree");
  Scene scene = sceneOf(mesh);
  scene.kinds[0].leaf.fill({.reflectance = 0.3f, .transmittance = 0.2f});
  for (const bool periodic : {false, true}) {
    if (periodic) {
      scene.stand.period = glm::vec2(1.7f, 2.3f);
      scene.stand.trees.push_back({.position = {0.4f, 0.5f, 0.2f}, .rotation = 1.f});
    }
    const Scene made = turbid(scene, 0.2f);
    EXPECT_EQ(made.kinds[0].mesh->leaf_count, 0u);
    EXPECT_TRUE(made.kinds[0].mesh->leaf_triangles.empty());
    EXPECT_EQ(made.kinds[0].mesh->wood_triangles.size(), mesh.wood_triangles.size());
    ASSERT_EQ(made.media.size(), 1u);
    EXPECT_EQ(made.media[0].optics, scene.kinds[0].leaf);
    EXPECT_NEAR(made.media[0].grid->leafArea(), area * static_cast<double>(scene.stand.trees.size()), 1e-4 * area);
    const Bounds leaves = bounds(scene), cells = bounds(made);
    for (int axis = periodic ? 2 : 0; axis < 3; ++axis) {
      EXPECT_NEAR(cells.low[axis], leaves.low[axis], 1e-5f);
      EXPECT_NEAR(cells.high[axis], leaves.high[axis], 1e-5f);
    }
    const std::vector<TraceMedium> media = traceMedia(made);
    ASSERT_EQ(media.size(), 1u);
    EXPECT_NO_THROW(validate(media[0], made.stand.period));
    EXPECT_FALSE(media[0].voxels->leaves.empty());
  }
  TreeMesh flat;
  addPolygon(flat, flat.leaf_triangles, rectangle({0.f, 0.f, 1.f}, {0.5f, 0.f, 0.f}, {0.f, 0.5f, 0.f}));
  finish(flat, "leaf");
  EXPECT_NO_THROW(validate(traceMedia(turbid(sceneOf(flat), 0.3f))[0], {}));
}

// Check the kinds and the rings of media of a scene, and that one without end needs a period.
TEST(R15_SceneMedia, MediaOfAScene) {
  Scene scene = sceneOf(leafBox(5, 1));
  scene.stand.period = glm::vec2(3.f);
  SceneMedium fog{.particles = true, .asymmetry = 0.5f, .density = 2.f};
  fog.box.low.z = 1.f;
  fog.box.high.z = 2.f;
  SceneMedium leaves = fog;
  leaves.particles = false;
  leaves.angles = "planophile";
  scene.media = {fog, leaves};
  const std::vector<TraceMedium> media = traceMedia(scene);
  EXPECT_EQ(media[0].scatterer, TraceMedium::Scatterer::particles);
  EXPECT_EQ(media[0].asymmetry, 0.5f);
  EXPECT_TRUE(media[0].rings.empty());
  EXPECT_EQ(media[1].scatterer, TraceMedium::Scatterer::leaves);
  EXPECT_EQ(media[1].rings.size(), static_cast<std::size_t>(LeafAngles::kNodes));
  EXPECT_EQ(media[1].box.high.z, 2.f);
  const Bounds box = bounds(scene);  // a period about the trees where media have no end
  EXPECT_NEAR(box.size().x, 3.f, 1e-5f);
  EXPECT_EQ(box.high.z, 2.f);
  scene.stand.period.reset();
  EXPECT_THROW(traceMedia(scene), InvalidInput);
}
