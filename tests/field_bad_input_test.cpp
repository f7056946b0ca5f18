// Check what the field makes of meshes and light at the edge of what there is: either it says in one line what is
// wrong, or all that it tells is a number, the light adds up, and where it has not found a steady state it says so.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "core/require.hpp"
#include "field/clumping.hpp"
#include "field/grid_field.hpp"
#include "field/leaf_field.hpp"
#include "plants/random_leaves.hpp"
#include "sky/sky_models.hpp"
#include "tests/leaf_shapes.hpp"

using namespace sunfleck;
using namespace sunfleck::shapes;

namespace {

const Direction kDown(0.f, 0.f, -1.f);

TreeMesh crown() {
  return randomCrown({.size = {1.f, 1.f, 1.f}, .leaf_side = 0.1f, .leaves = 300}, 1);
}

// Level squares of these sides.
TreeMesh squares(const std::vector<float>& sides, float apart) {
  TreeMesh mesh;
  float height = 0.f;
  for (const float side : sides) {
    addPolygon(mesh, mesh.leaf_triangles,
               rectangle({0.f, 0.f, height}, {0.5f * side, 0.f, 0.f}, {0.f, 0.5f * side, 0.f}));
    height += apart;
  }
  finish(mesh, "squares");
  return mesh;
}

// A cube of 1 m whose faces are leaves, with a leaf in it.
TreeMesh closedBox() {
  TreeMesh mesh = squares({0.5f}, 0.f);
  for (int axis = 0; axis < 3; ++axis)
    for (const float sign : {-1.f, 1.f}) {
      glm::vec3 centre(0.f), a(0.f), b(0.f);
      centre[axis] = 0.5f * sign;
      a[(axis + 1) % 3] = -0.5f * sign;
      b[(axis + 2) % 3] = 0.5f;
      addPolygon(mesh, mesh.leaf_triangles, rectangle(centre, a, b));
    }
  finish(mesh, "box");
  return mesh;
}

struct Case {
  TreeMesh mesh = crown();
  std::optional<glm::vec2> period{};
  LeafOptics leaf{.reflectance = 0.5f, .transmittance = 0.45f};
  Direction sun = kDown;
  float ground = 0.f;          // with a period [1]
  std::optional<float> sky{};  // radiance
};

void expectLight(float value) {
  EXPECT_TRUE(std::isfinite(value) && value >= 0.f) << value;
}

// Answers whether it found a steady state.
bool solvedOnLines(const Case& of) {
  LeafField field;
  field.setStand(std::array{std::shared_ptr<const TreeMesh>(std::make_shared<TreeMesh>(of.mesh))},
                 Stand{.period = of.period});
  FieldLighting lighting{.suns = {{.along = of.sun}}, .kinds = {FieldKind{}}, .ground_albedo = glm::vec3(of.ground)};
  lighting.kinds[0].leaf.fill(of.leaf);
  if (of.sky) lighting.sky = std::make_shared<SkyMap>(uniformSky(glm::dvec3(double{*of.sky})));
  const FieldResult& result = field.solve(lighting);
  for (const LeafLight& leaf : result.trees.front())
    for (std::size_t band = 0; band < kBands; ++band)
      for (const SideIrradiance& light : {leaf.direct[band], leaf.scattered[band]}) {
        expectLight(light.front);
        expectLight(light.back);
      }
  const FieldBalance& balance = result.balance[0];
  const double out =
      balance.absorbed_leaves + balance.absorbed_wood + balance.absorbed_ground + balance.out_up + balance.out_down;
  // What iteration leaves is told for each source by itself, as an error of all sides' light, which in a box or a heap
  // of leaves is many times what comes in.
  EXPECT_NEAR(out, balance.in, 0.05 * balance.in);
  EXPECT_EQ(result.converged, result.error_bound <= SolverEffort{}.error);
  return result.converged;
}

bool solvedOnCells(const Case& of) {
  const FieldElements elements = fieldElements(of.mesh);
  const PlacedElements tree{.mesh = &of.mesh, .elements = &elements};
  CellMedium alone = cellMedium({&tree, 1}, {.cells = 8});
  const float omega = clumping(of.mesh, alone);
  GridField field(of.period ? cellMedium({&tree, 1}, {.cells = 8, .ground = leafBounds(of.mesh).low.z}, of.period)
                            : std::move(alone),
                  std::array{omega});
  const float sky = of.sky.value_or(0.f), dark = 0.f;
  const GridSolution found =
      field.solve({.optics = {{{.leaf = of.leaf}}},
                   .direct = directLight(of.mesh, elements, of.period, of.sun).irradiance,
                   .entering = field.evenSky({&sky, 1}, {&dark, 1},
                                             of.period ? std::vector<float>{of.ground} : std::vector<float>{})});
  for (const float value : found.irradiance) expectLight(value);
  EXPECT_EQ(found.told.empty(), found.error_bound <= 0.005);
  if (found.told.empty()) {
    EXPECT_NEAR(found.balance[0].residual(), 0., 0.02);
  }
  return found.told.empty();
}

template <typename Work>
void refuses(const std::string& part, const Work& work) {
  try {
    work();
    ADD_FAILURE() << "accepted: " << part;
  } catch (const InvalidInput& mistake) {
    EXPECT_NE(std::string(mistake.what()).find(part), std::string::npos) << mistake.what();
    EXPECT_EQ(std::string(mistake.what()).find('\n'), std::string::npos);
  }
}

void refusesMesh(const std::string& part, const TreeMesh& mesh) {
  refuses(part, [&] { solvedOnLines({.mesh = mesh}); });
  const FieldElements none;  // there are none of such a mesh
  const PlacedElements tree{.mesh = &mesh, .elements = &none};
  refuses(part, [&] { cellMedium({&tree, 1}); });
}

}  // namespace

TEST(F4_LeafField, RefusesMeshesThatAreNone) {
  refusesMesh("number of leaves = 0", {});
  for (const float value : {std::nanf(""), std::numeric_limits<float>::infinity(), 1e6f}) {
    TreeMesh mesh = crown();
    mesh.vertices[5].y = value;
    refusesMesh("vertex 6 y", mesh);
  }
  TreeMesh flat = crown(), beyond = crown(), other = crown();
  flat.vertices[1] = flat.vertices[0];
  refusesMesh("leaf triangle 1 area = 0", flat);
  beyond.leaf_triangles[7].z = 1'000'000;
  refusesMesh("vertex index = 1000000", beyond);
  other.leaf_of_triangle[7] = 1'000'000;
  refusesMesh("leaf of a triangle = 1000000", other);
  // Too small for single precision: left out by those who finish a mesh.
  EXPECT_THROW(squares({1e-25f}, 0.f), InvalidInput);
}

TEST(F4_LeafField, RefusesSunsThatAreNone) {
  for (const Direction& along : {Direction(1.f, 0.f, 0.f), Direction(0.f, 0.f, 1.f)})
    refuses("z of the sunlight's direction", [&] { solvedOnLines({.sun = along}); });
  refuses("length of the sunlight's direction", [&] { solvedOnLines({.sun = {std::nanf(""), 0.f, -1.f}}); });
  refuses("length of the sunlight's direction", [&] { solvedOnLines({.sun = {0.f, 0.f, -2.f}}); });
}

TEST(F4_LeafField, SolvesLeavesOfAnySizeAndNumber) {
  for (const TreeMesh& mesh : {squares({0.1f}, 0.f), squares({1e-6f}, 0.f), squares({1e4f}, 0.f),
                               squares({1e-6f, 1e4f}, 1.f), squares(std::vector<float>(3000, 0.1f), 0.f)}) {
    EXPECT_TRUE(solvedOnLines({.mesh = mesh}));
    EXPECT_TRUE(solvedOnCells({.mesh = mesh}));
  }
  // A level crown: a box without height.
  TreeMesh flat = crown();
  for (glm::vec3& vertex : flat.vertices) vertex.z = 1.f;
  finish(flat, "flat");
  EXPECT_TRUE(solvedOnLines({.mesh = flat}));
  EXPECT_TRUE(solvedOnCells({.mesh = flat}));
}

TEST(F4_LeafField, SolvesSkiesWithoutLight) {
  for (const float zenith : {0.f, 1.5690f, 1.5707f}) {
    const Case of{.sun = sunlight(zenith, 0.3f), .sky = 0.f};
    EXPECT_TRUE(solvedOnLines(of));
    EXPECT_TRUE(solvedOnCells(of));
  }
}

// Check albedo 1, and what single precision has next to it, where light can leave: a crown alone, and one without end
// on black and on white ground, which sends up all that comes down.
TEST(F4_LeafField, SolvesWhiteLeavesWhereLightCanLeave) {
  for (const float transmittance : {0.5f, 0.5f - 6e-8f})
    for (const float ground : {-1.f, 0.f, 1.f}) {
      Case of{.leaf = {.reflectance = 0.5f, .transmittance = transmittance}};
      if (ground >= 0.f) {
        of.period = glm::vec2(1.1f, 1.2f);
        of.ground = ground;
        of.sky = 1.f;
      }
      EXPECT_TRUE(solvedOnLines(of));
      EXPECT_TRUE(solvedOnCells(of));
    }
}

// Check a box from which no light can leave. In cells light leaves every box: what they know of leaves is their
// density.
TEST(F5_Recollision, RefusesAClosedWhiteBox) {
  refuses("no steady state",
          [] { solvedOnLines({.mesh = closedBox(), .leaf = {.reflectance = 1.f, .transmittance = 0.f}}); });
  EXPECT_TRUE(solvedOnCells({.mesh = closedBox(), .leaf = {.reflectance = 1.f, .transmittance = 0.f}}));
  EXPECT_TRUE(solvedOnLines({.mesh = closedBox(), .leaf = {.reflectance = 0.9f, .transmittance = 0.f}}));
}

// Check that where light stays among thousands of leaves in one place, of which cells know that no light comes
// through, iteration ends, and says whether it has found what it looked for.
TEST(F17_GridField, EndsInAHeapOfWhiteLeaves) {
  solvedOnCells(
      {.mesh = squares(std::vector<float>(1000, 0.1f), 0.f), .leaf = {.reflectance = 0.5f, .transmittance = 0.5f}});
}
