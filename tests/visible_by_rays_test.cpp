#include "apps/visible_by_rays.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "plants/random_leaves.hpp"
#include "render/gl/stand_renderer.hpp"
#include "tests/leaf_shapes.hpp"

namespace {

using namespace sunfleck;

// Leaves about a trunk.
std::shared_ptr<const TreeMesh> tree(std::uint64_t seed) {
  TreeMesh mesh = randomCrown({.leaves = 800}, seed);
  shapes::addPolygon(mesh, mesh.wood_triangles, shapes::rectangle({0, 0, -1.f}, {0.3f, 0, 0}, {0, 0, 1.f}));
  shapes::addPolygon(mesh, mesh.wood_triangles, shapes::rectangle({0, 0, -1.f}, {0, 0.3f, 0}, {0, 0, 1.f}));
  finish(mesh, "tree");
  return std::make_shared<TreeMesh>(std::move(mesh));
}

// Trees of two kinds, one of them turned.
Scene someTrees() {
  Scene scene;
  scene.kinds = {TreeKind{.name = "a", .mesh = tree(1)}, TreeKind{.name = "b", .mesh = tree(2)}};
  scene.stand.trees = {{.position = {0.f, 0.f, 0.f}},
                       {.position = {2.2f, 0.5f, 0.f}, .rotation = 0.f, .kind = 1},
                       {.position = {0.5f, 2.4f, 0.2f}, .rotation = 1.f}};
  return scene;
}

struct Compared {
  int seen = 0, different = 0, unexplained = 0;
};

// Compares what OpenGL and rays see in a view. They may differ where the middle of a sample lies within `snap` of an
// edge of a triangle that one of them sees [pixel].
Compared compare(const Scene& scene, const Camera& camera, float snap) {
  StandGeometry geometry({.light_resolution = 16, .sample_directions = 6, .sample_resolution = 16, .cells = 4});
  geometry.update(scene, {.compensation = false, .sky_light = false});
  const gl::DrawnStand stand = gl::drawnStand(scene, geometry);
  const gl::Context context;
  gl::StandRenderer renderer(context);
  renderer.update(stand);
  const glm::ivec2 size(camera.width - 10, camera.height - 20);
  gl::FrameTarget target(size, true);
  const gl::View view{.camera = camera, .model = Model::ss, .low = {10, 20}, .offset = {0.125f, -0.25f}};
  renderer.draw(view, target);
  const std::vector<std::uint32_t> drawn = target.readIds();
  context.requireNoError("drawing");
  const std::vector<glm::uvec2> by_rays = apps::VisibleByRays(stand)(view, size);

  const std::vector<glm::vec3> shifts = gl::copies(stand, glm::ivec2(gl::kDrawnAround));
  const glm::mat4 clip = gl::clipFromWorld(view, size, 100.f);
  const auto nearEdge = [&](std::uint32_t number, std::uint32_t triangle, const glm::dvec2& middle) {
    const gl::DrawnTree& of = stand.trees[number % stand.trees.size()];
    const TreeMesh& mesh = *stand.kinds[of.kind].tree.mesh;
    const std::size_t leaves = mesh.leaf_triangles.size();
    const glm::uvec3 t = triangle < leaves ? mesh.leaf_triangles[triangle] : mesh.wood_triangles[triangle - leaves];
    glm::dvec2 corners[3];
    for (int i = 0; i < 3; ++i) {
      const glm::dvec4 at(clip *
                          glm::vec4(mesh.vertices[t[i]] + of.position + shifts[number / stand.trees.size()], 1.f));
      corners[i] = 0.5 * (glm::dvec2(at) / at.w + 1.) * glm::dvec2(size);
    }
    for (int i = 0; i < 3; ++i) {
      const glm::dvec2 a = corners[i], along = corners[(i + 1) % 3] - a;
      const double share = glm::clamp(glm::dot(middle - a, along) / std::max(1e-12, glm::dot(along, along)), 0., 1.);
      if (glm::length(middle - a - share * along) < double{snap}) return true;
    }
    return false;
  };
  Compared compared;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const auto pixel = static_cast<std::size_t>(y * size.x + x);
      glm::uvec2 of_gl(drawn[4 * pixel], drawn[4 * pixel + 1]);
      const std::uint32_t trees = static_cast<std::uint32_t>(stand.trees.size() * shifts.size());
      const bool gl_sees = of_gl.x < trees, rays_see = by_rays[pixel].x < trees;
      compared.seen += gl_sees || rays_see;
      if (gl_sees == rays_see && (!gl_sees || of_gl == by_rays[pixel])) continue;
      ++compared.different;
      const glm::dvec2 middle(x + 0.5, y + 0.5);
      compared.unexplained += !((gl_sees && nearEdge(of_gl.x, of_gl.y, middle)) ||
                                (rays_see && nearEdge(by_rays[pixel].x, by_rays[pixel].y, middle)));
    }
  return compared;
}

// OpenGL moves corners to whole 1/256 of a pixel, the nearest (OpenGL asks for 1/16 or finer): an edge moves by half
// that along each axis. A twentieth more is for rounding.
constexpr float kSnap = 1.05f * 0.70711f / 256.f;
// A middle is that near to an edge by chance with 2 * 0.0029 times the length of edges in a square pixel: leaves of
// 0.1 m are 8 pixels wide or more in these pictures and half covered by others, so that there is less than 1 pixel of
// edge in one.
constexpr double kShare = 0.006;

// (R32) Check that rays see the drawn trees and triangles that OpenGL sees, in every pixel but those whose middle lies
// on an edge to within OpenGL's snapping of corners: in an orthographic picture, from an eye, from an eye among the
// trees, and in a periodic stand with its copies.
TEST(R32_VisibleByRays, IsWhatOpenGlSees) {
  Scene scene = someTrees();
  Camera camera{.target = {0.9f, 0.9f, 0.f}, .elevation = 0.4f, .azimuth = 0.3f, .half_width = 2.5f};
  camera.width = 330;
  camera.height = 280;
  const auto check = [&](const char* what) {
    const Compared compared = compare(scene, camera, kSnap);
    EXPECT_GT(compared.seen, 15'000) << what;
    EXPECT_LT(compared.different, kShare * compared.seen) << what;
    EXPECT_EQ(compared.unexplained, 0) << what << ", of " << compared.different;
  };
  check("orthographic");
  camera.field_of_view = glm::radians(50.f);
  check("in perspective");
  scene.stand.period = glm::vec2(5.f, 4.5f);
  check("periodic");
  camera.half_width = 1.f;
  check("among the trees");
}

}  // namespace
