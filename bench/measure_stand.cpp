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
#include <cstdlib>
#include <numbers>
#include <numeric>
#include <string>

#include "core/elapsed.hpp"
#include "core/require.hpp"
#include "field/large_stand.hpp"
#include "plants/import.hpp"
#include "plants/random_leaves.hpp"
#include "plants/species.hpp"
#include "render/compare/category_errors.hpp"
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

Options optionsOf(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto next = [&] { return i + 1 < argc ? std::atof(argv[++i]) : 0.; };
    if (word == "--side")
      options.side = static_cast<int>(next());
    else if (word == "--sun")
      options.sun = static_cast<float>(next());
    else if (word == "--spacing")
      options.spacing = static_cast<float>(next());
    else if (word == "--albedo")
      options.albedo = static_cast<float>(next());
    else if (word == "--split")
      options.split = static_cast<float>(next());
    else if (word == "--ground")
      options.ground = static_cast<float>(next());
    else if (word == "--paths")
      options.paths = static_cast<std::uint64_t>(next());
    else if (word == "--cells")
      options.effort.cells_along = static_cast<int>(next());
    else if (word == "--periodic")
      options.periodic = true;
    else if (word == "--wood")
      options.wood = true;
    else if (word == "--whole")
      options.whole = true;
    else if (word == "--turn")
      options.turn = true;
    else
      options.trees.push_back(word);
  }
  return options;
}

TreeMesh treeOf(const std::string& name, std::uint64_t seed) {
  if (name == "crown") return randomCrown({.leaves = 10'000}, seed);
  if (name.find('.') != std::string::npos) return importTree(name).mesh;
  return grow(species(name), seed);
}

Scene sceneOf(const Options& options) {
  Scene scene;
  scene.kinds.clear();
  scene.stand.trees.clear();
  float width = 0.f;
  for (const std::string& name : options.trees) {
    TreeKind& kind = scene.kinds.emplace_back();
    TreeMesh mesh = treeOf(name, scene.kinds.size());
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
  fmt::print("\nMonte Carlo: noise {:.2f} % of categories, {:.2f} % of leaves\n",
             100. * *categoryNoise(truth.leaf_irradiance, truth.leaf_standard_error, groups),
             100. * *referenceNoise(truth.leaf_irradiance, truth.leaf_standard_error));
  const auto tell = [&](const char* name, const FieldResult& judged) {
    const ModelErrors errors = modelErrors(leafIrradiance(judged, scene, 0), truth.leaf_irradiance, groups);
    fmt::print("{:<8} w {:5.2f} uw {:5.2f} leaf {:5.2f} bias {:+5.2f} %\n", name, 100. * *errors.rms_weighted,
               100. * *errors.rms_category, 100. * *errors.rms_leaf, 100. * *errors.bias);
  };
  tell("stand", result);
  tell("far", byCells(result, scene, field, all));
  if (!options.whole) return;
  LeafField whole;
  whole.setStand(kinds, scene.stand);
  tell("as one", whole.solve(fieldLighting(scene)));
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = optionsOf(argc, argv);
  try {
    if (options.trees.empty()) throw InvalidInput("trees: none: must be at least 1");
    measure(options);
  } catch (const InvalidInput& mistake) {
    fmt::print(stderr, "measure_stand: {}\n", mistake.what());
    return 2;
  }
}
