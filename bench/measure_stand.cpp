// The field of trees of a stand, each by itself in the light of the others (F29), against Monte Carlo: errors by
// category, per leaf and in all; the same told by cells alone, as of far trees; and, with --whole, of the stand solved
// as one.
//   measure_stand TREE... [--side N] [--spacing X] [--sun DEG] [--albedo X] [--split X] [--ground X] [--cells N]
//                 [--paths N] [--periodic] [--wood] [--turn] [--whole]
// N x N trees in rows, in turn of each kind, X widest crowns apart. A tree is a species, a file, or "crown" of random
// leaves.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

#include "bench/leaf_errors.hpp"
#include "bench/measurement.hpp"
#include "core/elapsed.hpp"
#include "field/large_stand.hpp"
#include "render/compare/validation.hpp"
#include "render/leaf_models.hpp"
#include "render/stand_field.hpp"
#include "render/stand_geometry.hpp"

using namespace sunfleck;

namespace {

struct Options {
  std::vector<std::string> trees;
  int side = 4;
  float sun = 45.f, spacing = 1.f, albedo = 0.95f, split = 0.5f, ground = 0.f;
  std::uint64_t paths = 4'000'000;
  bool periodic = false, wood = false, whole = false, turn = false;
  LargeStandEffort effort;
};

void addOptions(CLI::App& app, Options& options) {
  app.add_option("trees", options.trees)->required();
  app.add_option("--side", options.side);
  app.add_option("--spacing", options.spacing);
  app.add_option("--sun", options.sun);
  app.add_option("--albedo", options.albedo);
  app.add_option("--split", options.split);
  app.add_option("--ground", options.ground);
  app.add_option("--cells", options.effort.cells_along);
  app.add_option("--paths", options.paths);
  app.add_flag("--periodic", options.periodic);
  app.add_flag("--wood", options.wood);
  app.add_flag("--turn", options.turn);
  app.add_flag("--whole", options.whole);
}

Scene sceneOf(const Options& options) {
  Scene scene;
  scene.kinds.clear();
  scene.stand.trees.clear();
  float width = 0.f;
  for (const std::string& name : options.trees) {
    TreeKind& kind = scene.kinds.emplace_back();
    TreeMesh mesh = measuredTree(name, scene.kinds.size(), {.leaves = 10'000});
    if (!options.wood) mesh.wood_triangles.clear();
    const glm::vec3 size = leafBounds(mesh).size();
    width = std::max({width, size.x, size.y});
    kind.mesh = std::make_shared<const TreeMesh>(std::move(mesh));
    kind.leaf.fill(
        {.reflectance = options.split * options.albedo, .transmittance = (1.f - options.split) * options.albedo});
  }
  const float apart = options.spacing * width;
  for (int i = 0; i < options.side * options.side; ++i)
    scene.stand.trees.push_back(
        {.position = {apart * static_cast<float>(i % options.side), apart * static_cast<float>(i / options.side), 0.f},
         .rotation = options.turn ? 0.4f * static_cast<float>(i % 16) : 0.f,
         .kind = static_cast<std::uint32_t>(i) % static_cast<std::uint32_t>(scene.kinds.size())});
  if (options.periodic) scene.stand.period = glm::vec2(apart * static_cast<float>(options.side));
  scene.ground_albedo = glm::vec3(options.ground);
  scene.suns = {Sun{.zenith = options.sun * std::numbers::pi_v<float> / 180.f, .azimuth = 0.5f}};
  return scene;
}

// The same with what cells tell in place of what is scattered to each leaf.
FieldResult byCells(FieldResult result, const Scene& scene, LargeStandField& field,
                    std::span<const std::size_t> trees) {
  field.solve(fieldLighting(scene), {}, trees);
  for (const std::size_t tree : trees) {
    const std::uint32_t kind = scene.stand.trees[tree].kind;
    const FieldElements& elements = field.elements(kind);
    std::array<std::vector<float>, 2> of_sides;
    for (std::size_t side = 0; side < 2; ++side) {
      std::vector<float> of_elements(elements.size());
      for (std::size_t i = 0; i < of_elements.size(); ++i)
        of_elements[i] = field.farSides(tree)[field.farSidesOf(kind)[2 * i + side]].x;
      of_sides[side] = leafMeans(elements, scene.kinds[kind].mesh->leaf_count, of_elements);
    }
    for (std::size_t leaf = 0; leaf < of_sides[0].size(); ++leaf)
      result.trees[tree][leaf].scattered[0] = {of_sides[0][leaf], of_sides[1][leaf]};
  }
  return result;
}

void measure(const Options& options) {
  const Scene scene = sceneOf(options);
  std::vector<std::shared_ptr<const TreeMesh>> kinds;
  for (const TreeKind& kind : scene.kinds) kinds.push_back(kind.mesh);
  std::vector<std::size_t> all(scene.stand.trees.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  LargeStandField field(options.effort);
  const Elapsed elapsed;
  field.setStand(kinds, scene.stand);
  const FieldResult result = field.solve(fieldLighting(scene), all);
  fmt::print("{} trees: CPU {:.2f} s (wall {:.2f}); cells of {:.2f} m, {} that hold something; iterations {} + {};",
             all.size(), elapsed.cpuSeconds(), elapsed.seconds(), field.stats().cell_side, field.stats().cells,
             field.stats().cell_iterations, result.iterations);
  for (const float omega : field.stats().clumping) fmt::print(" Omega {:.2f}", omega);
  double absorbed = 0.;
  for (const std::size_t tree : all) {
    const std::vector<double> areas = leafAreas(*kinds[scene.stand.trees[tree].kind]);
    for (std::size_t leaf = 0; leaf < areas.size(); ++leaf) {
      const LeafLight& light = result.trees[tree][leaf];
      absorbed +=
          areas[leaf] * (1. - double{options.albedo}) *
          double{light.direct[0].front + light.direct[0].back + light.scattered[0].front + light.scattered[0].back};
    }
  }
  fmt::print("\nabsorbed by leaves, over what they absorb in cells: {:.4f}\n",
             absorbed / result.balance[0].absorbed_leaves);
  for (const ProductCost& cost : field.costs()) fmt::print("  {} {:.0f} ms", cost.name, 1e3 * cost.seconds);

  const RayScene rays(meshes(scene), scene.stand, options.wood);
  const ForwardResult truth = traceForward(rays, traceLight(scene, 0), {.paths = options.paths});
  StandGeometry stand;
  stand.update(scene);
  const std::vector<Category> groups = categories(meanDepths(leafGeometry(scene, stand)));
  const auto tell = [&](const char* name, const FieldResult& judged) {
    const LeafErrors errors = leafErrors(leafIrradiance(judged, scene, 0), truth, groups);
    fmt::print("{:<8} w {:5.2f} (noise {:4.2f}) uw {:5.2f} leaf {:5.2f} (noise {:4.2f}) bias {:+5.2f} %\n", name,
               errors.weighted, errors.weighted_noise, errors.by_category, errors.leaf, errors.leaf_noise, errors.bias);
  };
  fmt::print("\n");
  tell("stand", result);
  tell("far", byCells(result, scene, field, all));
  if (!options.whole) return;
  LeafField whole;
  whole.setStand(kinds, scene.stand);
  tell("as one", whole.solve(fieldLighting(scene)));
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  return measurement(
      "measure_stand", argc, argv, [&](CLI::App& app) { addOptions(app, options); }, [&] { measure(options); });
}
