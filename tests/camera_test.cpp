#include "render/camera.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <memory>

#include "render/scene.hpp"

using namespace sunfleck;

namespace {

// Of a point in the camera's picture: from the middle, right and up, 1 at its edges; by the definition of a pinhole.
glm::vec2 seenAt(const Camera& camera, const glm::vec3& point) {
  const Axes axes = viewAxes(camera);
  glm::vec3 away = point - camera.target;
  const float at_target = camera.half_width;
  float half = at_target;
  if (camera.perspective()) {
    away = point - eyeOf(camera);
    half = std::tan(0.5f * camera.field_of_view) * glm::dot(away, axes.along);
  }
  const float aspect = static_cast<float>(camera.width) / static_cast<float>(camera.height);
  return {glm::dot(away, axes.right) / half, glm::dot(away, axes.up) / half * aspect};
}

Scene sceneOf(std::vector<glm::vec3> vertices) {
  auto mesh = std::make_shared<TreeMesh>();
  mesh->vertices = std::move(vertices);
  for (std::uint32_t i = 0; i + 2 < mesh->vertices.size(); ++i) mesh->leaf_triangles.push_back({i, i + 1, i + 2});
  finish(*mesh, "test");
  Scene scene;
  scene.kinds[0].mesh = mesh;
  return scene;
}

Camera cameraWith(float field_of_view_deg, float elevation = 0.3f, float azimuth = 1.f) {
  return {.target = {1.f, -2.f, 3.f},
          .elevation = elevation,
          .azimuth = azimuth,
          .half_width = 2.5f,
          .field_of_view = glm::radians(field_of_view_deg),
          .width = 64,
          .height = 40};
}

}  // namespace

// Check lines of sight against a pinhole's definition: a point along the line through a place is seen there, and the
// target in the middle. The eye stands as far away as the half width at the target takes. Error: a few roundings of
// coordinates of 100 m by pixels of 5 cm.
TEST(R30_Camera, PointsAlongALineOfSightAreSeenAtItsPlace) {
  for (const float field : {0.f, 3.f, 50.f, 150.f}) {
    const Camera camera = cameraWith(field);
    EXPECT_LT(glm::length(seenAt(camera, camera.target)), 1e-5f);
    if (camera.perspective()) {
      EXPECT_NEAR(glm::distance(eyeOf(camera), camera.target) * std::tan(0.5f * camera.field_of_view), 2.5f, 1e-4f);
    }
    for (const glm::vec2 place :
         {glm::vec2(0.f), glm::vec2(32.f, 20.f), glm::vec2(63.5f, 2.25f), glm::vec2(64.f, 40.f)})
      for (const float distance : {1.f, 100.f}) {
        const Sight sight = sightThrough(camera, place);
        EXPECT_NEAR(glm::length(sight.along), 1.f, 1e-6f);
        const glm::vec2 seen = seenAt(camera, sight.from + distance * sight.along);
        const glm::vec2 expected(place.x / 32.f - 1.f, 1.f - place.y / 20.f);
        EXPECT_LT(glm::length(seen - expected), 1e-4f) << field << " " << distance;
      }
  }
}

// Check the sides of what is seen: each passes through its edge of the picture, at any depth, and has the middle
// inside.
TEST(R30_Camera, SidesPassThroughThePicturesEdges) {
  for (const float field : {0.f, 40.f, 120.f}) {
    const Camera camera = cameraWith(field);
    const auto sides = sidesOfSight(camera);
    const glm::vec2 edges[] = {{0.f, 11.f}, {64.f, 11.f}, {5.f, 40.f}, {5.f, 0.f}};  // left, right, bottom, top
    for (int side = 0; side < 4; ++side) {
      const auto distance = [&](const glm::vec2& place, float depth) {
        const Sight sight = sightThrough(camera, place);
        return glm::dot(glm::vec3(sides[static_cast<std::size_t>(side)]), sight.from + depth * sight.along) +
               sides[static_cast<std::size_t>(side)].w;
      };
      for (const float depth : {0.5f, 30.f}) {
        EXPECT_NEAR(distance(edges[side], depth), 0.f, 2e-5f) << field;  // roundings of 30 m
        EXPECT_GT(distance({32.f, 20.f}, depth), 0.1f);
      }
    }
  }
}

// Check that the camera made to show all shows every vertex, nearly touches one at an edge (the margin is 1 / 1.08)
// unless so wide a view would bring it too near to another, and keeps its direction and its field of view.
TEST(R30_Camera, ShowsAllInPerspective) {
  const Scene scene = sceneOf({{1, 0, 0}, {3, 0, 1}, {1, 1, 9}, {-2, 6, 4}, {0, 0, 0}, {5, -3, 2}});
  for (const float field : {0.f, 0.1f, 10.f, 60.f, 150.f})
    for (const float elevation : {-0.5f, 0.2f, 1.5f}) {
      const Camera camera = showingAll(scene, cameraWith(field, elevation));
      EXPECT_EQ(camera.elevation, elevation);
      EXPECT_EQ(camera.field_of_view, glm::radians(field));
      float farthest = 0.f;
      for (const glm::vec3& vertex : scene.kinds[0].mesh->vertices) {
        const glm::vec2 seen = glm::abs(seenAt(camera, vertex));
        farthest = std::max({farthest, seen.x, seen.y});
        if (camera.perspective()) {
          EXPECT_GT(glm::dot(vertex - eyeOf(camera), viewAxes(camera).along), 0.5f);
        }
      }
      // At 0.1 degrees the eye is 6 km away and slopes are 1e-3: a rounding of 6 km is 1e-4 of the picture.
      EXPECT_LT(farthest, 1.f / 1.08f + 1e-3f) << field << " " << elevation;
      EXPECT_GT(farthest, field > 100.f ? 0.2f : 1.f / 1.08f - 1e-3f) << field << " " << elevation;
    }
}

// Check which trees may be seen: those in front and inside of the sides, none behind the eye; in a periodic stand all.
TEST(R30_Camera, TreesBehindTheEyeAreNotSeen) {
  Scene scene = sceneOf({{0, 0, 0}, {0.2f, 0, 0.1f}, {0, 0.2f, 0.2f}});
  // The camera stands at x = +5 and looks towards -x, 90 degrees wide.
  const Camera camera{.half_width = 5.f, .field_of_view = glm::radians(90.f), .width = 8, .height = 8};
  scene.stand.trees = {{.position = {0, 0, 0}},    {.position = {6, 0, 0}},    {.position = {0, 4.7f, 0}},
                       {.position = {3, 4.7f, 0}}, {.position = {-95, 90, 0}}, {.position = {4.9f, 0, 0}}};
  EXPECT_EQ(treesInPicture(scene, camera), (std::vector<std::size_t>{0, 2, 4, 5}));
  Camera flat = camera;
  flat.field_of_view = 0.f;
  EXPECT_EQ(treesInPicture(scene, flat), (std::vector<std::size_t>{0, 1, 2, 3, 5}));
  scene.stand.period = glm::vec2(200.f);
  EXPECT_EQ(treesInPicture(scene, camera).size(), 6u);
}

// Check which trees' light may be seen on the ground: of those whose shadow, cast as far as they are high by a sun at
// 45 degrees, falls into the picture; not by night, nor where the ground reflects nothing.
TEST(R30_Camera, TreesBesideAreSeenByTheirShadows) {
  Scene scene = sceneOf({{0, 0, 0}, {0.2f, 0, 0}, {0, 0.2f, 4}});
  scene.stand.trees = {{.position = {0, 0, 0}}, {.position = {-4, 0, 0}}, {.position = {4, 0, 0}}};
  const Camera down{.elevation = glm::radians(90.f), .half_width = 1.f, .width = 8, .height = 8};
  scene.suns = {{.zenith = glm::radians(45.f), .azimuth = glm::radians(180.f)}};  // light travels towards +x
  EXPECT_EQ(treesInPicture(scene, down), (std::vector<std::size_t>{0}));
  scene.ground_albedo = glm::vec3(0.f, 0.1f, 0.f);
  EXPECT_EQ(treesInPicture(scene, down), (std::vector<std::size_t>{0, 1}));
  scene.suns.push_back({.zenith = glm::radians(45.f)});
  EXPECT_EQ(treesInPicture(scene, down), (std::vector<std::size_t>{0, 1, 2}));
  for (Sun& sun : scene.suns) sun.zenith = glm::radians(120.f);
  EXPECT_EQ(treesInPicture(scene, down), (std::vector<std::size_t>{0}));
}
