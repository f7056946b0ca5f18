#include "render/stand_field.hpp"

#include <algorithm>
#include <map>

#include "core/require.hpp"
#include "core/revision.hpp"
#include "grid/cell_grid.hpp"
#include "grid/leaf_depth.hpp"

namespace sunfleck {
namespace {

constexpr int kWoodCells = 16;  // along the longest side of a tree
constexpr std::size_t kMostFieldLeaves = 2'000'000;

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

bool fieldFits(const Scene& scene) {
  return leavesOf(scene) <= kMostFieldLeaves;
}

void requireField(const Scene& scene) {
  require(fieldFits(scene), (scene.origin.empty() ? "" : scene.origin + ": ") + "leaves of all trees", leavesOf(scene),
          "at most " + std::to_string(kMostFieldLeaves) + " for the model field (others take more)");
}

StandField::StandField(const FieldEffort& effort, const CellFieldEffort& cells) : field_(effort), on_cells_(cells) {}

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
  const SunAndSky shining = sunAndSky(scene);
  const bool same_sky = sky_map_ && shining.sky && scene.sky == sky_ &&
                        (scene.sky.kind != SceneSky::Kind::preetham ||
                         (scene.sun().zenith == sky_sun_.zenith && scene.sun().azimuth == sky_sun_.azimuth));
  FieldLighting lighting{
      .suns = {}, .sky = same_sky ? sky_map_ : shining.sky, .kinds = {}, .ground_albedo = scene.ground_albedo};
  for (std::size_t i = 0; i < scene.suns.size(); ++i)
    if (shining.suns[i] != glm::vec3(0.f))
      lighting.suns.push_back({.along = scene.suns[i].light(), .irradiance = shining.suns[i]});
  for (const TreeKind& kind : scene.kinds)
    lighting.kinds.push_back({.leaf = kind.leaf, .wood_reflectance = kind.wood_reflectance});
  return lighting;
}

bool StandField::upToDate(const Scene& scene) const {
  return field_.upToDate(meshesOf(scene), scene.stand, lightingOf(scene));
}

void StandField::update(const Scene& scene, FieldBy by, const Progress& progress, const GroundGrid& ground) {
  requireField(scene);
  const std::vector<std::shared_ptr<const TreeMesh>> meshes = meshesOf(scene);
  result_ = nullptr;
  by_ = by;
  const FieldLighting lighting = lightingOf(scene);
  sky_ = scene.sky;
  sky_sun_ = scene.sun();
  sky_map_ = lighting.sky;
  const auto solved = [&](auto& field) {
    field.setStand(meshes, scene.stand);
    const FieldResult& result = field.solve(lighting, progress);
    ground_ = ground.size.x > 0 ? field.groundLight(ground) : std::vector<glm::vec3>();
    return &result;
  };
  result_ = by == FieldBy::lines ? solved(field_) : solved(on_cells_);
  kinds_.resize(meshes.size());
  for (std::size_t i = 0; i < meshes.size(); ++i)
    if (kinds_[i].mesh != meshes[i]) kinds_[i] = kindOf(meshes[i]);
  sides_.resize(scene.stand.trees.size());
  revision_ = newRevisions();
  for (std::size_t tree = 0; tree < sides_.size(); ++tree) {
    const Kind& kind = kinds_[scene.stand.trees[tree].kind];
    std::vector<glm::vec3>& sides = sides_[tree];
    sides.clear();
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
