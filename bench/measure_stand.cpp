// The field of stands of many trees against Monte Carlo and against all of their leaves solved as one.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <numeric>
#include <string>

#include "core/elapsed.hpp"
#include "core/require.hpp"
#include "field/large_stand.hpp"
#include "grid/leaf_depth.hpp"
#include "plants/import.hpp"
#include "plants/random_leaves.hpp"
#include "plants/species.hpp"
#include "render/compare/category_errors.hpp"
#include "render/compare/validation.hpp"
#include "render/leaf_models.hpp"
#include "render/reference/forward_trace.hpp"
#include "render/stand_field.hpp"
#include "render/stand_geometry.hpp"

using namespace sunfleck;

namespace {
TreeMesh treeOf(const std::string& name) {
  if (name.starts_with("crown")) return randomCrown({.leaves = 10000}, static_cast<std::uint64_t>(std::atoi(name.c_str() + 5)) + 1);
  if (name.find('.') != std::string::npos) return importTree(name).mesh;
  return grow(species(name), 1);
}
}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> names;
  int side = 4;
  float zenith = 0.f, spacing = 1.f, albedo = 0.95f, split = 0.5f, ground = 0.f;
  std::uint64_t paths = 4'000'000;
  bool periodic = false, wood = false, whole = false, turn = false;
  std::size_t most_seen = 1u << 30;
  LargeStandEffort effort;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto next = [&] { return std::atof(argv[++i]); };
    if (word == "--side") side = static_cast<int>(next());
    else if (word == "--sun") zenith = static_cast<float>(next());
    else if (word == "--spacing") spacing = static_cast<float>(next());
    else if (word == "--albedo") albedo = static_cast<float>(next());
    else if (word == "--split") split = static_cast<float>(next());
    else if (word == "--ground") ground = static_cast<float>(next());
    else if (word == "--paths") paths = static_cast<std::uint64_t>(next());
    else if (word == "--cells") effort.cells_along = static_cast<int>(next());
    else if (word == "--most-cells") effort.most_cells = next();
    else if (word == "--pixels") effort.pixels = static_cast<float>(next());
    else if (word == "--axes") effort.exchange.axes = static_cast<int>(next());
    else if (word == "--seen") most_seen = static_cast<std::size_t>(next());
    else if (word == "--periodic") periodic = true;
    else if (word == "--wood") wood = true;
    else if (word == "--whole") whole = true;
    else if (word == "--turn") turn = true;
    else names.push_back(word);
  }
  Scene scene;
  scene.kinds.clear();
  scene.stand.trees.clear();
  float width = 0.f;
  for (const std::string& name : names) {
    TreeKind kind;
    auto mesh = std::make_shared<TreeMesh>(treeOf(name));
    if (!wood) mesh->wood_triangles.clear();
    const glm::vec3 size = leafBounds(*mesh).size();
    width = std::max({width, size.x, size.y});
    kind.mesh = mesh;
    for (auto& leaf : kind.leaf) leaf = {.reflectance = split * albedo, .transmittance = (1.f - split) * albedo};
    scene.kinds.push_back(kind);
  }
  for (int i = 0; i < side * side; ++i)
    scene.stand.trees.push_back({.position = {spacing * width * static_cast<float>(i % side), spacing * width * static_cast<float>(i / side), 0.f},
                                 .rotation = turn ? 0.4f * static_cast<float>(i % 16) : 0.f,
                                 .kind = static_cast<std::uint32_t>(i) % static_cast<std::uint32_t>(names.size())});
  if (periodic) scene.stand.period = glm::vec2(spacing * width * static_cast<float>(side));
  scene.ground_albedo = glm::vec3(ground);
  const Direction sun = sunlight(zenith * std::numbers::pi_v<float> / 180.f, 0.5f);
  std::vector<std::shared_ptr<const TreeMesh>> meshes;
  FieldLighting lighting{.suns = {FieldSun{.along = sun}}, .sky = {}, .kinds = {}, .ground_albedo = glm::vec3(ground)};
  for (const TreeKind& kind : scene.kinds) {
    meshes.push_back(kind.mesh);
    lighting.kinds.push_back({.leaf = kind.leaf, .wood_reflectance = kind.wood_reflectance});
  }
  std::vector<std::size_t> seen;
  for (std::size_t i = 0; i < std::min(most_seen, scene.stand.trees.size()); ++i) seen.push_back(i);
  try {
    LargeStandField field(effort);
    const Elapsed elapsed;
    field.setStand(meshes, scene.stand);
    std::vector<std::size_t> far;
    for (std::size_t i = seen.size(); i < scene.stand.trees.size(); ++i) far.push_back(i);
    const FieldResult& result = field.solve(lighting, seen, far);
    fmt::print("large: {:.2f} s wall {:.2f} s cpu; cell {:.2f} m, {} cells {} elements, {} cell its (bound {:.1e}), its {} bound {:.1e}", elapsed.seconds(), elapsed.cpuSeconds(),
               field.stats().cell_side, field.stats().cells, field.stats().elements, field.stats().cell_iterations, field.stats().cell_error, result.iterations, result.error_bound);
    for (const float omega : field.stats().clumping) fmt::print(" omega {:.2f}", omega);
    const FieldBalance& b = result.balance[0];
    fmt::print("\n in {:.3f} leaves {:.3f} wood {:.3f} ground {:.3f} up {:.3f} else {:.3f} rest {:.1e}\n", b.in, b.absorbed_leaves / b.in, b.absorbed_wood / b.in, b.absorbed_ground / b.in, b.out_up / b.in, b.out_down / b.in,
               1. - (b.absorbed_leaves + b.absorbed_wood + b.absorbed_ground + b.out_up + b.out_down) / b.in);
    for (const ProductCost& cost : field.costs()) fmt::print("  {} {:.0f} ms", cost.name, 1e3 * cost.seconds);
    fmt::print("\n");
    double absorbed = 0.;
    for (const std::size_t tree : seen) {
      const TreeMesh& mesh = *meshes[scene.stand.trees[tree].kind];
      const std::vector<double> areas = leafAreas(mesh);
      for (std::size_t leaf = 0; leaf < areas.size(); ++leaf) {
        const LeafLight& l = result.trees[tree][leaf];
        absorbed += areas[leaf] * (1. - double{albedo}) * double{l.direct[0].front + l.direct[0].back + l.scattered[0].front + l.scattered[0].back};
      }
    }
    fmt::print(" absorbed by leaves in detail / in cells {:.4f}\n", absorbed / b.absorbed_leaves);
    if (seen.size() == scene.stand.trees.size() && whole) {
      LeafField all;
      const Elapsed again;
      all.setStand(meshes, scene.stand);
      const FieldResult& truth = all.solve(lighting);
      double squares = 0., of_truth = 0., sum = 0., of_sum = 0., total_off = 0.;
      for (std::size_t tree = 0; tree < seen.size(); ++tree) {
        double mine = 0., its = 0.;
        for (std::size_t leaf = 0; leaf < truth.trees[tree].size(); ++leaf) {
          const auto of = [&](const LeafLight& l) { return double{l.direct[0].front + l.direct[0].back + l.scattered[0].front + l.scattered[0].back}; };
          const double x = of(result.trees[tree][leaf]), y = of(truth.trees[tree][leaf]);
          squares += (x - y) * (x - y);
          of_truth += y * y;
          mine += x;
          its += y;
        }
        total_off += std::pow(mine / its - 1., 2);
        sum += mine;
        of_sum += its;
      }
      fmt::print("  against all as one ({:.2f} s): per leaf {:.2f} %, bias {:+.2f} %, of trees {:.2f} %\n", again.seconds(), 100. * std::sqrt(squares / of_truth), 100. * (sum / of_sum - 1.),
                 100. * std::sqrt(total_off / static_cast<double>(seen.size())));
      const std::vector<float> a = leafIrradiance(truth, scene, 0);
    }
    if (paths > 0 && seen.size() == scene.stand.trees.size()) {
      const RayScene rays(sunfleck::meshes(scene), scene.stand, wood);
      std::vector<LeafOptics> leaf;
      for (const TreeKind& kind : scene.kinds) leaf.push_back(kind.leaf[0]);
      scene.suns = {Sun{.zenith = zenith * std::numbers::pi_v<float> / 180.f, .azimuth = 0.5f}};
      const ForwardResult truth = traceForward(rays, traceLight(scene, 0), {.paths = paths});
      StandGeometry stand{GeometryEffort{}};
      stand.update(scene);
      const LeafGeometry geometry = leafGeometry(scene, stand, {});
      const std::vector<Category> groups = categories(meanDepths(geometry));
      const auto tell = [&](const char* name, const std::vector<float>& model) {
        const ModelErrors errors = modelErrors(model, truth.leaf_irradiance, groups);
        const double noise = *referenceNoise(truth.leaf_irradiance, truth.leaf_standard_error);
        fmt::print("  {}: w {:.2f} % uw {:.2f} leaf {:.2f} (noise {:.2f}) bias {:+.2f}; category noise {:.2f}\n", name, 100. * *errors.rms_weighted, 100. * *errors.rms_category, 100. * *errors.rms_leaf, 100. * noise,
                   100. * *errors.bias, 100. * *categoryNoise(truth.leaf_irradiance, truth.leaf_standard_error, groups));
      };
      tell("large", leafIrradiance(result, scene, 0));
      {
        LargeStandField cells(effort);
        cells.setStand(meshes, scene.stand);
        cells.solve(lighting, {}, seen);
        FieldResult by_cells = result;
        for (const std::size_t tree : seen) {
          const std::uint32_t kind = scene.stand.trees[tree].kind;
          const FieldElements& elements = cells.elements(kind);
          std::vector<float> front(elements.size()), back(elements.size());
          for (std::size_t e = 0; e < elements.size(); ++e) {
            front[e] = cells.farSides(tree)[cells.farSidesOf(kind)[2 * e]].x;
            back[e] = cells.farSides(tree)[cells.farSidesOf(kind)[2 * e + 1]].x;
          }
          const auto f = leafMeans(elements, meshes[kind]->leaf_count, front), k = leafMeans(elements, meshes[kind]->leaf_count, back);
          for (std::size_t leaf = 0; leaf < f.size(); ++leaf) by_cells.trees[tree][leaf].scattered[0] = {f[leaf], k[leaf]};
        }
        tell("far", leafIrradiance(by_cells, scene, 0));
      }
      if (whole) {
        LeafField all;
        all.setStand(meshes, scene.stand);
        tell("as one", leafIrradiance(all.solve(lighting), scene, 0));
      }
    }
  } catch (const InvalidInput& mistake) {
    fmt::print(stderr, "measure_stand: {}\n", mistake.what());
    return 2;
  }
}
