// Check what pictures by the light field show of leaves and of the ground.
#include <gtest/gtest.h>

#include <array>
#include <glm/geometric.hpp>
#include <numbers>
#include <set>

#include "render/shading/fragment_shading.hpp"
#include "tests/drawn_woods.hpp"

namespace {

using namespace sunfleck;
using namespace sunfleck::woods;

// The field of a stand, of any figures: a place for each leaf, as the front and the back of leaf i of tree t have them.
struct SomeField {
  std::vector<std::vector<std::uint32_t>> places, far_places;  // those that are far have leaves the other way round
  std::vector<std::vector<glm::vec3>> sides;

  explicit SomeField(const Woods& woods) {
    for (const TreeKind& kind : woods.scene.kinds) {
      places.emplace_back(kind.mesh->leaf_of_triangle.begin(), kind.mesh->leaf_of_triangle.end());
      far_places.emplace_back();
      for (const std::uint32_t leaf : kind.mesh->leaf_of_triangle)
        far_places.back().push_back(kind.mesh->leaf_count - 1 - leaf);
    }
    for (std::size_t tree = 0; tree < woods.scene.stand.trees.size(); ++tree) {
      sides.emplace_back();
      const TreeMesh& mesh = *woods.scene.kindOf(woods.scene.stand.trees[tree]).mesh;
      for (std::size_t side = 0; side < 2 * std::size_t{mesh.leaf_count}; ++side) {
        const auto number = static_cast<float>(side % 97), of = static_cast<float>(tree);
        sides.back().push_back(0.01f * glm::vec3(number, 97.f - number, 7.f * of));
      }
    }
  }
  static bool isFar(std::size_t tree) { return tree % 2 == 1; }
  // Tells it of the stand, of all but the last tree.
  void tell(gl::DrawnStand& stand, std::uint64_t revision) const {
    for (std::size_t kind = 0; kind < places.size(); ++kind) {
      stand.kinds[kind].field_places = places[kind];
      stand.kinds[kind].far_field_places = far_places[kind];
    }
    for (std::size_t tree = 0; tree + 1 < sides.size(); ++tree) {
      stand.trees[tree].field = {sides[tree], revision};
      stand.trees[tree].far = isFar(tree);
    }
  }
};

// (F26) Check what a picture by the field shows against C++ and the figures told of each leaf's sides: those of the
// side that is seen and of the other, in the suns' light and in the sky's; of a tree that is far those of its places
// there; of a tree of which nothing is told nothing; and that what has changed is sent, and nothing else.
TEST(F26_FieldPicture, ShowsTheFieldOfEachLeafAndSide) {
  Woods woods;
  SomeField field(woods);
  gl::DrawnStand stand = woods.stand();
  field.tell(stand, 1);
  Drawing drawing(stand);
  const Camera camera = woods.camera();
  const glm::vec3 along = viewAxes(camera).along;
  shading::ShadingData data;
  update(data, Model::field, woods.scene.kinds, {});
  const shading::FragmentShading shading(Model::field, data);
  std::set<bool> fronts;
  for (std::uint64_t revision = 1; revision <= 2; ++revision) {
    const Image image = drawing.picture(camera, {.model = Model::field, .samples = 1, .layers = kAll});
    int leaves = 0, not_told = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const auto at = [&](const char* name) { return value(image, x, y, name); };
        if (at("id.leaf") < 0.f) continue;
        const auto tree = static_cast<std::size_t>(at("id.tree")), leaf = static_cast<std::size_t>(at("id.leaf"));
        const TreeMesh& mesh = *woods.scene.kindOf(woods.scene.stand.trees[tree]).mesh;
        const glm::vec3 normal(at("normal.X"), at("normal.Y"), at("normal.Z"));
        const glm::uvec3 t = mesh.leaf_triangles[static_cast<std::size_t>(at("id.triangle"))];
        const glm::vec3 a = mesh.vertices[t.x], b = mesh.vertices[t.y], c = mesh.vertices[t.z];
        const std::size_t same = glm::dot(glm::cross(b - a, c - a), along) <= 0.f ? 0 : 1;
        fronts.insert(same == 0);
        const bool told = tree + 1 < field.sides.size();
        (told ? leaves : not_told) += 1;
        const shading::Surface surface =
            shading.leafSurface(static_cast<std::uint32_t>(at("id.kind")), {}, 0, 0, normal, -along);
        const std::vector<glm::vec3>& sides = field.sides[tree];
        const std::size_t place = SomeField::isFar(tree) ? mesh.leaf_count - 1 - leaf : leaf;
        const glm::vec3 expected =
            told ? shading.shadeBySides(surface, sides[2 * place + same], sides[2 * place + 1 - same]).scattered
                 : glm::vec3(0.f);
        const std::array bands{"R", "G", "B"};
        for (int band = 0; band < 3; ++band) {
          const std::string name = bands[static_cast<std::size_t>(band)];
          ASSERT_NEAR(at(("multiple." + name).c_str()), expected[band], kShading * (1.f + expected[band]));
          ASSERT_EQ(at(("sky." + name).c_str()), 0.f);
        }
      }
    EXPECT_GT(leaves, 1000);
    EXPECT_GT(not_told, 100);
    for (glm::vec3& side : field.sides[1]) side *= 0.5f;
    EXPECT_EQ(drawing.renderer.update(stand).field, 0u);
    stand.trees[1].field.revision = 2;
    const std::size_t sent = drawing.renderer.update(stand).field;
    EXPECT_EQ(sent, revision == 1 ? field.sides[1].size() * sizeof(glm::vec4) : 0u);
  }
  EXPECT_EQ(fronts.size(), 2u);
}

// (F31) Check what the ground shows of the light that trees scatter, which rises evenly from cell to cell here: as much
// between their middles as at them; over the outermost two cells it fades, beyond there is none, and none by other
// models.
TEST(F31_FieldPicture, ShowsTheLightOnTheGround) {
  Woods woods;
  woods.scene.sky = {};
  gl::DrawnStand stand = woods.stand();
  GroundGrid& grid = stand.ground_sky.grid;
  grid.size = {16, 12};
  grid.low = glm::vec2(woods.scene.stand.trees[0].position) - 1.f;
  grid.cell_size = glm::vec2(0.5f, 0.6f);
  const auto expected = [&](const glm::vec2& place) {
    const glm::vec2 cell = (place - grid.low) / grid.cell_size - 0.5f;
    return glm::vec3(1.f, 0.5f + 0.1f * cell.x, 0.2f + 0.05f * cell.y);
  };
  std::vector<glm::vec3> values;
  for (int y = 0; y < grid.size.y; ++y)
    for (int x = 0; x < grid.size.x; ++x)
      values.push_back(expected(grid.low + grid.cell_size * (glm::vec2(x, y) + 0.5f)));
  stand.ground_field = {values, 1};
  Drawing drawing(stand);
  const Camera camera = woods.camera();
  const Image image = drawing.picture(camera, {.model = Model::field, .samples = 1, .layers = kAll}),
              other = drawing.picture(camera, {.model = Model::ss, .samples = 1, .layers = kAll});
  const glm::vec2 high = grid.low + grid.cell_size * glm::vec2(grid.size);
  int within = 0, beyond = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float coverage = value(image, x, y, "A");
      if (value(image, x, y, "id.tree") >= 0.f || coverage == 0.f) continue;
      EXPECT_EQ(value(other, x, y, "multiple.R"), 0.f);
      const Sight look = sightThrough(camera, {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f});
      const glm::vec2 place(look.from + value(image, x, y, "depth.Z") * look.along);
      const glm::vec2 inside = glm::min(place - grid.low, high - place) / grid.cell_size;  // [cell]
      const float least = std::min(inside.x, inside.y);
      if (least < -0.01f) {
        ++beyond;
        EXPECT_EQ(value(image, x, y, "multiple.R"), 0.f);
      } else if (least > 2.01f) {
        ++within;
        const glm::vec3 light = coverage * woods.scene.ground_albedo * expected(place) / std::numbers::pi_v<float>;
        // Places of some 10 m are told to 1e-5 of a cell; slopes are up to a fifth of the value.
        EXPECT_NEAR(value(image, x, y, "multiple.R"), light.x, 1e-5f);
        EXPECT_NEAR(value(image, x, y, "multiple.G"), light.y, 1e-5f);
        EXPECT_NEAR(value(image, x, y, "multiple.B"), light.z, 1e-5f);
      }
    }
  EXPECT_GT(within, 100);
  EXPECT_GT(beyond, 100);
}

}  // namespace
