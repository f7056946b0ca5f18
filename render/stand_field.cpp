#include "render/stand_field.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>

#include "core/require.hpp"
#include "core/revision.hpp"
#include "grid/cell_grid.hpp"
#include "grid/leaf_depth.hpp"

namespace sunfleck {
namespace {

constexpr int kWoodCells = 16;                        // along the longest side of a tree
constexpr std::size_t kMostAsOne = 2'000'000;         // leaves of a stand whose trees are solved together
constexpr std::size_t kMostNear = 10'000'000;         // of those trees of a picture that have a place for each
constexpr std::size_t kMostFieldLeaves = 40'000'000;  // of which it can be told: about 100 bytes for each

std::vector<std::shared_ptr<const TreeMesh>> meshesOf(const Scene& scene) {
  std::vector<std::shared_ptr<const TreeMesh>> meshes;
  for (const TreeKind& kind : scene.kinds) meshes.push_back(kind.mesh);
  return meshes;
}

std::size_t leavesOf(const Scene& scene) {
  std::size_t leaves = 0;
  for (const Placement& tree : scene.stand.trees) leaves += scene.kindOf(tree).mesh->leaf_count;
  return leaves;
}

}  // namespace

FieldLighting fieldLighting(const Scene& scene) {
  const SunAndSky shining = sunAndSky(scene);
  FieldLighting lighting{.suns = {}, .sky = shining.sky, .kinds = {}, .ground_albedo = scene.ground_albedo};
  for (std::size_t i = 0; i < scene.suns.size(); ++i)
    if (shining.suns[i] != glm::vec3(0.f))
      lighting.suns.push_back({.along = scene.suns[i].light(), .irradiance = shining.suns[i]});
  for (const TreeKind& kind : scene.kinds)
    lighting.kinds.push_back({.leaf = kind.leaf, .wood_reflectance = kind.wood_reflectance});
  return lighting;
}

bool fieldFits(const Scene& scene) {
  return leavesOf(scene) <= kMostFieldLeaves;
}

void requireField(const Scene& scene) {
  require(fieldFits(scene), (scene.origin.empty() ? "" : scene.origin + ": ") + "leaves of all trees", leavesOf(scene),
          "at most " + std::to_string(kMostFieldLeaves) + " for the model field (others take more)");
}

StandField::StandField(const FieldEffort& effort, const CellFieldEffort& cells)
    : effort_(effort), field_(effort), on_cells_(cells) {}

std::vector<ProductCost> StandField::costs() const {
  std::vector<ProductCost> costs;
  const auto add = [&](const std::string& of, const std::vector<ProductCost>& products) {
    for (ProductCost cost : products) {
      cost.name = of + ": " + cost.name;
      costs.push_back(std::move(cost));
    }
  };
  add("field", field_.costs());
  add("preview", on_cells_.costs());
  if (large_) add("large stand", large_->costs());
  return costs;
}

StandField::Kind StandField::kindOf(const std::shared_ptr<const TreeMesh>& mesh) {
  Kind kind{.mesh = mesh, .places = {}, .leaves_around = {}};
  kind.places.assign(mesh->leaf_of_triangle.begin(), mesh->leaf_of_triangle.end());
  if (mesh->wood_triangles.empty() || mesh->leaf_triangles.empty()) return kind;
  const CellGrid cells = cellGrid(*mesh, kWoodCells);
  const auto cellOf = [&](const glm::vec3& point) {
    const glm::ivec3 cell(glm::floor((point - cells.low) / cells.cell_size));
    return cells.number(glm::clamp(cell, glm::ivec3(0), cells.size - 1));
  };
  std::map<std::size_t, std::vector<std::uint32_t>> of_cells;
  std::vector<std::uint32_t> all;
  const std::vector<glm::vec3> centres = leafCentres(*mesh);
  for (std::uint32_t leaf = 0; leaf < mesh->leaf_count; ++leaf) {
    of_cells[cellOf(centres[leaf])].push_back(leaf);
    all.push_back(leaf);
  }
  // Where there are no leaves around, all of them count.
  std::map<std::size_t, std::uint32_t> place_of_cell;
  kind.leaves_around.push_back(std::move(all));
  for (auto& [cell, leaves] : of_cells) {
    place_of_cell[cell] = mesh->leaf_count + static_cast<std::uint32_t>(kind.leaves_around.size());
    kind.leaves_around.push_back(std::move(leaves));
  }
  for (const glm::uvec3& t : mesh->wood_triangles) {
    const auto found =
        place_of_cell.find(cellOf((mesh->vertices[t.x] + mesh->vertices[t.y] + mesh->vertices[t.z]) / 3.f));
    kind.places.push_back(found == place_of_cell.end() ? mesh->leaf_count : found->second);
  }
  return kind;
}

// A sky that is as before stays the same map, of which no light is computed again.
FieldLighting StandField::lightingOf(const Scene& scene) const {
  FieldLighting lighting = fieldLighting(scene);
  const bool same_sky = sky_map_ && lighting.sky && scene.sky == sky_ &&
                        (scene.sky.kind != SceneSky::Kind::preetham ||
                         (scene.sun().zenith == sky_sun_.zenith && scene.sun().azimuth == sky_sun_.azimuth));
  if (same_sky) lighting.sky = sky_map_;
  return lighting;
}

bool StandField::upToDate(const Scene& scene) const {
  return leavesOf(scene) > kMostAsOne || field_.upToDate(meshesOf(scene), scene.stand, lightingOf(scene));
}

// (F28) Trees in the order of their distance from the camera: leaf by leaf as many as there is room for, then by cells.
void StandField::updateLarge(const Scene& scene, const FieldLighting& lighting,
                             std::optional<std::span<const std::size_t>> trees, const Progress& progress) {
  if (!trees) requireField(scene);
  if (!large_)
    large_ = std::make_unique<LargeStandField>(LargeStandEffort{
        .elements = effort_.elements, .exchange = effort_.exchange, .solver = effort_.solver, .cells = {}});
  std::vector<std::size_t> seen(scene.stand.trees.size()), far;
  std::iota(seen.begin(), seen.end(), std::size_t{0});
  if (trees) {
    seen.assign(trees->begin(), trees->end());
    const Camera camera = cameraOf(scene);
    const glm::vec3 from = camera.perspective() ? eyeOf(camera) : camera.target;
    std::ranges::stable_sort(seen, {}, [&](std::size_t tree) {
      const glm::vec3 away = scene.stand.trees[tree].position - from;
      return glm::dot(away, away);
    });
    std::size_t leaves = 0, near = 0;
    for (; near < seen.size() && leaves <= kMostNear; ++near)
      leaves += scene.kindOf(scene.stand.trees[seen[near]]).mesh->leaf_count;
    far.assign(seen.begin() + static_cast<std::ptrdiff_t>(near), seen.end());
    seen.resize(near);
  }
  large_->setStand(meshesOf(scene), scene.stand);
  result_ = &large_->solve(lighting, seen, far, progress);
  far_.assign(far.empty() ? 0 : scene.stand.trees.size(), false);
  for (const std::size_t tree : far) far_[tree] = true;
}

void StandField::update(const Scene& scene, FieldBy by, const Progress& progress, const GroundGrid& ground,
                        std::optional<std::span<const std::size_t>> trees) {
  const std::vector<std::shared_ptr<const TreeMesh>> meshes = meshesOf(scene);
  result_ = nullptr;
  by_ = by;
  far_.clear();
  const FieldLighting lighting = lightingOf(scene);
  sky_ = scene.sky;
  sky_sun_ = scene.sun();
  sky_map_ = lighting.sky;
  if (leavesOf(scene) > kMostAsOne) {
    updateLarge(scene, lighting, trees, progress);
    ground_.clear();
  } else {
    const auto solved = [&](auto& field) {
      field.setStand(meshes, scene.stand);
      const FieldResult& result = field.solve(lighting, progress);
      ground_ = ground.size.x > 0 ? field.groundLight(ground) : std::vector<glm::vec3>();
      return &result;
    };
    result_ = by == FieldBy::lines ? solved(field_) : solved(on_cells_);
  }
  kinds_.resize(meshes.size());
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    if (kinds_[i].mesh != meshes[i]) kinds_[i] = kindOf(meshes[i]);
    kinds_[i].far_places.clear();
    const auto of_sides =
        far_.empty() ? std::span<const std::uint32_t>() : large_->farSidesOf(static_cast<std::uint32_t>(i));
    if (of_sides.empty()) continue;
    // A place has the light of its front, then of its back: those of a group, or exchanged.
    const FieldElements& elements = large_->elements(static_cast<std::uint32_t>(i));
    for (const auto* of_triangles : {&elements.of_leaf_triangle, &elements.of_wood_triangle})
      for (const std::uint32_t element : *of_triangles) kinds_[i].far_places.push_back(of_sides[2 * element]);
  }
  sides_.resize(scene.stand.trees.size());
  revision_ = newRevisions();
  for (std::size_t tree = 0; tree < sides_.size(); ++tree) {
    const Kind& kind = kinds_[scene.stand.trees[tree].kind];
    std::vector<glm::vec3>& sides = sides_[tree];
    sides.clear();
    if (isFar(tree)) {
      const std::span<const glm::vec3> of_groups = large_->farSides(tree);
      for (std::size_t side = 0; side < of_groups.size(); ++side)
        sides.insert(sides.end(), {of_groups[side], of_groups[side ^ 1]});
      continue;
    }
    if (result_->trees[tree].empty()) continue;
    for (const LeafLight& leaf : result_->trees[tree]) {
      glm::vec3 front, back;
      for (int band = 0; band < kBands; ++band) {
        front[band] = leaf.scattered[static_cast<std::size_t>(band)].front;
        back[band] = leaf.scattered[static_cast<std::size_t>(band)].back;
      }
      sides.push_back(front);
      sides.push_back(back);
    }
    for (const std::vector<std::uint32_t>& around : kind.leaves_around) {
      glm::vec3 sum(0.f);
      for (const std::uint32_t leaf : around) sum += sides[2 * leaf] + sides[2 * leaf + 1];
      sides.insert(sides.end(), 2, sum / (2.f * static_cast<float>(around.size())));
    }
  }
}

std::vector<float> leafIrradiance(const FieldResult& field, const Scene& scene, int band) {
  std::vector<std::size_t> first{0};
  for (const TreeKind& kind : scene.kinds) first.push_back(first.back() + kind.mesh->leaf_count);
  std::vector<float> irradiance(first.back(), 0.f);
  const auto b = static_cast<std::size_t>(band);
  for (std::size_t tree = 0; tree < field.trees.size(); ++tree) {
    const std::uint32_t kind = scene.stand.trees[tree].kind;
    const auto alike = static_cast<float>(std::ranges::count(scene.stand.trees, kind, &Placement::kind));
    for (std::size_t leaf = 0; leaf < field.trees[tree].size(); ++leaf) {
      const LeafLight& light = field.trees[tree][leaf];
      irradiance[first[kind] + leaf] +=
          (light.direct[b].front + light.direct[b].back + light.scattered[b].front + light.scattered[b].back) / alike;
    }
  }
  return irradiance;
}

Scene withoutWood(const Scene& scene) {
  Scene bare = scene;
  for (TreeKind& kind : bare.kinds) {
    if (kind.mesh->wood_triangles.empty()) continue;
    TreeMesh mesh = *kind.mesh;
    mesh.wood_triangles.clear();
    kind.mesh = std::make_shared<const TreeMesh>(std::move(mesh));
  }
  return bare;
}

}  // namespace sunfleck
