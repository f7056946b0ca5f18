#include "render/stand_geometry.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <numbers>
#include <string>
#include <utility>

#include "core/require.hpp"
#include "core/revision.hpp"
#include "grid/neighbours.hpp"
#include "render/stand_field.hpp"
#include "sky/sky_shares.hpp"

namespace sunfleck {
namespace {

std::string beginning(const Scene& scene) {
  return scene.origin.empty() ? "" : scene.origin + ": ";
}

// As Monte Carlo turns trees.
std::shared_ptr<const TreeMesh> turned(const std::shared_ptr<const TreeMesh>& mesh, float rotation) {
  if (rotation == 0.f) return mesh;
  auto result = std::make_shared<TreeMesh>(*mesh);
  const float cosine = std::cos(rotation), sine = std::sin(rotation);
  for (glm::vec3& v : result->vertices) v = {cosine * v.x - sine * v.y, sine * v.x + cosine * v.y, v.z};
  return result;
}

// The scene's kinds, not turned, and those that are turned, in the order of their first trees.
struct Kinds {
  std::vector<StandKind> kinds;
  std::vector<std::size_t> of_trees;
};
Kinds kindsOf(const Scene& scene) {
  Kinds found;
  for (std::uint32_t kind = 0; kind < scene.kinds.size(); ++kind) found.kinds.push_back({.kind = kind});
  for (const Placement& tree : scene.stand.trees) {
    std::size_t kind = tree.kind;
    if (tree.rotation != 0.f) {
      const auto same = std::find_if(found.kinds.begin(), found.kinds.end(), [&](const StandKind& of) {
        return of.kind == tree.kind && of.rotation == tree.rotation;
      });
      kind = static_cast<std::size_t>(same - found.kinds.begin());
      if (same == found.kinds.end()) found.kinds.push_back({.kind = tree.kind, .rotation = tree.rotation});
    }
    found.kinds[kind].stands = true;
    found.of_trees.push_back(kind);
  }
  return found;
}

// Cells an eighth as wide as the widest tree, so many that what the trees take from the sky is seen to its end: as far
// beyond them as they are high, and half as far again.
GroundGrid groundGrid(const Bounds& leaves, const Scene& scene) {
  constexpr float kPerTree = 8.f, kAround = 1.5f, kMostCells = 256.f;
  if (leaves.empty()) return {};
  float width = 0.f;
  for (const TreeKind& kind : scene.kinds)
    width = std::max({width, bounds(*kind.mesh).size().x, bounds(*kind.mesh).size().y});
  const float around = scene.stand.period ? 0.f : kAround * leaves.size().z;
  const glm::vec2 extent = scene.stand.period.value_or(glm::vec2(leaves.size()) + 2.f * around);
  const float side = std::max({width / kPerTree, extent.x / kMostCells, extent.y / kMostCells, 1e-6f});
  GroundGrid grid{.low = glm::vec2(leaves.low) - around, .height = leaves.low.z};
  grid.size = glm::clamp(glm::ivec2(glm::ceil(extent / side)), 1, static_cast<int>(kMostCells));
  grid.cell_size = extent / glm::vec2(grid.size);
  return grid;
}

void requireSurfaces(const Scene& scene) {
  requireWholeLeaves(scene, "the models");
  if (scene.ground_rpv || scene.ground_texture[0])
    throw InvalidInput(beginning(scene) + "ground.kind = " + (scene.ground_rpv ? "\"rpv\"" : "\"texture\"") +
                       ": must be \"lambert\" for the models (trace takes any)");
}

void requireStand(const Scene& scene) {
  const Stand& stand = scene.stand;
  const std::string from = beginning(scene);
  require(stand.trees.size() <= kMostDrawnTrees, from + "number of trees in [stand]", stand.trees.size(),
          "at most " + std::to_string(kMostDrawnTrees) + " for the models (trace takes any)");
  const Kinds kinds = kindsOf(scene);
  const auto standing = static_cast<std::size_t>(
      std::count_if(kinds.kinds.begin(), kinds.kinds.end(), [](const StandKind& kind) { return kind.stands; }));
  require(standing <= kMostKinds, from + "number of kinds of trees, each rotation_deg counted", standing,
          "at most " + std::to_string(kMostKinds) +
              " for the models, which make maps of each: turn trees by whole steps (trace takes any)");
  std::vector<Bounds> boxes;
  for (const TreeKind& kind : scene.kinds) boxes.push_back(leafBounds(*kind.mesh));
  for (const StandKind& kind : kinds.kinds) {
    if (!kind.stands) continue;
    const TreeKind& of = scene.kinds[kind.kind];
    if (of.mesh->leaf_triangles.empty())
      throw InvalidInput(from + "tree \"" + of.name + "\": must have leaves for the models (trace takes any)");
    if (stand.period)
      periodsAround(stand, kind.rotation == 0.f ? boxes[kind.kind] : leafBounds(*turned(of.mesh, kind.rotation)));
  }
  requireApart(stand, boxes);
}

}  // namespace

void requireWholeLeaves(const Scene& scene, const std::string& what) {
  for (const TreeKind& kind : scene.kinds)
    if (!kind.mesh->masks.empty())
      throw InvalidInput(beginning(scene) + "\"" + kind.name +
                         "\" has leaves that masks cut out (cards = \"mask\"): must be cut to triangles for " + what +
                         " (trace alone takes masks)");
}

void requireDrawable(const Scene& scene) {
  requireSurfaces(scene);
  requireStand(scene);
}

void requireModelled(const Scene& scene) {
  const Stand& stand = scene.stand;
  const std::string from = beginning(scene);
  for (const TreeKind& kind : scene.kinds)
    for (const LeafOptics& leaf : kind.leaf)
      require(leaf.gloss == 0.f, from + "leaf gloss", leaf.gloss,
              "0 for the models, whose leaves scatter by Lambert's law (trace and render take any)");
  require(stand.trees.size() <= kMostTrees, from + "number of trees in [stand]", stand.trees.size(),
          "at most " + std::to_string(kMostTrees) + " for the models (trace takes any)");
  if (scene.sky.kind != SceneSky::Kind::none || scene.suns.size() != 1 || scene.sun().irradiance != glm::vec3(1.f) ||
      scene.sun().diameter != 0.f)
    throw InvalidInput(from +
                       "[sky], a second [[sun]], sun.irradiance and sun.diameter_deg: must be left out for the models' "
                       "irradiance of leaves, which is that under one sun, a point of irradiance 1 (trace and render "
                       "take any)");
  require(scene.sun().up(), from + "sun.zenith_deg", glm::degrees(scene.sun().zenith),
          "in [0, 89.9] for the models' irradiance of leaves: above the horizon");
  require(!stand.trees.empty(), from + "number of trees in [stand]", stand.trees.size(), "at least 1");
  requireDrawable(scene);
}

GeometryNeeds needsOf(Model model) {
  const bool field = model == Model::field;
  return {.compensation = needsCompensation(model),
          .sky_light = !field,
          .ground_light = needsCompensation(model),
          .field = field};
}

StandGeometry::StandGeometry(const GeometryEffort& effort, MapMaker light_map)
    : effort_(effort),
      foliage_(std::make_unique<FoliageStand>(FoliageEffort{.axes = spreadAxes(effort.sample_directions / 2),
                                                            .sample_resolution = effort.sample_resolution,
                                                            .light_resolution = effort.light_resolution,
                                                            .cells = effort.cells,
                                                            .light_map = std::move(light_map)})) {
  static_assert(FoliageStand::kMostLights == kMostSuns);
}

StandGeometry::~StandGeometry() = default;
StandGeometry::StandGeometry(StandGeometry&&) noexcept = default;
StandGeometry& StandGeometry::operator=(StandGeometry&&) noexcept = default;

// The kinds that stand, by prototypes: the same as before where there are such, so that what is known of them stays.
void StandGeometry::updatePrototypes(const Scene& scene) {
  for (Prototype& prototype : prototypes_) prototype.used = false;
  of_kinds_.assign(kinds_.size(), {});
  std::vector<char> found(kinds_.size(), 0);
  const auto take = [&](const auto& fits) {
    for (std::size_t kind = 0; kind < kinds_.size(); ++kind)
      for (std::size_t i = 0; i < prototypes_.size() && kinds_[kind].stands && !found[kind]; ++i) {
        if (prototypes_[i].used || !fits(prototypes_[i], kinds_[kind])) continue;
        of_kinds_[kind].prototype = i;
        found[kind] = prototypes_[i].used = true;
      }
  };
  const auto sameTree = [&](const Prototype& p, const StandKind& kind) {
    return p.mesh == scene.kinds[kind.kind].mesh && p.rotation == kind.rotation;
  };
  take([&](const Prototype& p, const StandKind& kind) { return sameTree(p, kind) && p.kind == kind.kind; });
  take(sameTree);
  take([](const Prototype& p, const StandKind& kind) { return p.kind == kind.kind && p.rotation == kind.rotation; });
  take([](const Prototype&, const StandKind&) { return true; });
  for (std::size_t kind = 0; kind < kinds_.size(); ++kind) {
    if (!kinds_[kind].stands) continue;
    const bool added = !found[kind];
    if (added) {
      of_kinds_[kind].prototype = prototypes_.size();
      prototypes_.push_back({.used = true});
    }
    Prototype& prototype = prototypes_[of_kinds_[kind].prototype];
    if (added || !sameTree(prototype, kinds_[kind])) {
      prototype.mesh = scene.kinds[kinds_[kind].kind].mesh;
      prototype.rotation = kinds_[kind].rotation;
      prototype.turned = turned(prototype.mesh, prototype.rotation);
      if (added)
        foliage_->addPrototype(prototype.turned);
      else
        foliage_->replacePrototype(of_kinds_[kind].prototype, prototype.turned);
    }
    prototype.kind = kinds_[kind].kind;
    kinds_[kind].mesh = prototype.turned;
  }
}

void StandGeometry::updateKinds(const Scene& scene) {
  std::vector<std::shared_ptr<const TreeMesh>> meshes;
  for (const TreeKind& kind : scene.kinds) meshes.push_back(kind.mesh);
  if (scene.stand == stand_ && meshes == meshes_) return;
  requireStand(scene);
  if (scene.stand.period != stand_.period) foliage_->setPeriod(std::nullopt);  // the former may not suit the new trees
  meshes_.clear();                                                             // until all is done
  Kinds found = kindsOf(scene);
  kinds_ = std::move(found.kinds);
  kind_of_tree_ = std::move(found.of_trees);
  updatePrototypes(scene);
  std::vector<std::size_t> prototypes;
  for (const std::size_t kind : kind_of_tree_) prototypes.push_back(of_kinds_[kind].prototype);
  trees_.update(*foliage_, scene.stand.trees, prototypes);
  foliage_->setPeriod(scene.stand.period);
  leaves_ = bounds(scene);
  foliage_->setGround(groundGrid(leaves_, scene));
  of_instances_.resize(foliage_->instances());
  stand_ = scene.stand;
  meshes_ = std::move(meshes);
}

void StandGeometry::updateLights(const Scene& scene) {
  if (scene.suns == suns_ && scene.sky == sky_) return;
  shining_ = sunAndSky(scene);
  if (shining_.sky && shining_.sky->irradiance() == glm::dvec3(0.)) shining_.sky = nullptr;
  suns_ = scene.suns;
  sky_ = scene.sky;
  lights_.clear();
  std::vector<Direction> directions;
  for (std::size_t i = 0; i < suns_.size(); ++i) {
    if (shining_.suns[i] == glm::vec3(0.f)) continue;
    lights_.push_back({.sun = i, .along = suns_[i].light(), .irradiance = shining_.suns[i]});
    directions.push_back(lights_.back().along);
  }
  foliage_->setLights(directions);
  const std::vector<Direction> samples = foliage_->sampleDirections();
  const std::vector<glm::vec3> radiance =
      shining_.sky ? skyShares(*shining_.sky, samples) : std::vector<glm::vec3>(samples.size(), glm::vec3(0.f));
  foliage_->setSky(radiance);
  ground_sky_.open = shining_.sky ? glm::vec3(shining_.sky->irradiance()) : glm::vec3(0.f);
  glm::vec3 level(0.f);
  for (std::size_t j = 0; j < samples.size(); ++j)
    level += 4.f * std::numbers::pi_v<float> / static_cast<float>(samples.size()) * std::max(samples[j].z, 0.f) *
             radiance[j];
  for (int band = 0; band < kBands; ++band)
    sky_factor_[band] = level[band] > 0.f ? ground_sky_.open[band] / level[band] : 0.f;
}

// (D12) The ground sends the light of suns and sky back; that among the trees, in the mean, up to their cells.
void StandGeometry::updateGround(const Scene& scene, const GeometryNeeds& needs, const Progress& progress) {
  ground_radiance_ = glm::vec3(0.f);
  const bool sky = (needs.sky_light || needs.field) && shining_.sky;
  const GroundGrid& grid = ground_sky_.grid = foliage_->ground();
  if (scene.ground_albedo == glm::vec3(0.f) || grid.size.x == 0 || !(sky || needs.ground_light)) {
    ground_sky_.irradiance = {};
    ground_sky_.revision = 0;
    return;
  }
  foliage_->prepareGround(progress);
  if (ground_sky_.revision != foliage_->groundSkyRevision() || ground_sky_.irradiance.empty()) {
    ground_irradiance_.clear();
    for (const glm::vec3& by_samples : foliage_->groundSky()) ground_irradiance_.push_back(sky_factor_ * by_samples);
    ground_sky_.irradiance = ground_irradiance_;
    ground_sky_.revision = foliage_->groundSkyRevision();
  }
  if (!needs.ground_light) return;
  glm::dvec3 sum(0.);
  std::size_t among = 0;
  for (std::size_t i = 0; i < ground_irradiance_.size(); ++i) {
    const glm::ivec2 cell(static_cast<int>(i) % grid.size.x, static_cast<int>(i) / grid.size.x);
    const glm::vec2 centre = grid.low + grid.cell_size * (glm::vec2(cell) + 0.5f);
    if (centre.x < leaves_.low.x || centre.y < leaves_.low.y || centre.x > leaves_.high.x || centre.y > leaves_.high.y)
      continue;
    glm::vec3 irradiance = ground_irradiance_[i];
    for (std::size_t light = 0; light < lights_.size(); ++light)
      irradiance += lights_[light].irradiance * -lights_[light].along.z * foliage_->groundShare(light)[i];
    sum += irradiance;
    ++among;
  }
  if (among > 0)
    ground_radiance_ =
        scene.ground_albedo * std::numbers::inv_pi_v<float> * glm::vec3(sum / static_cast<double>(among));
}

// (D10) Light of the sky and of the ground, whose radiance changes with the sun and its share in the cells does not.
void StandGeometry::updateEnvironment(std::span<const std::size_t> instances, const GeometryNeeds& needs,
                                      const Progress& progress) {
  const bool sky = needs.sky_light && shining_.sky, ground = ground_radiance_ != glm::vec3(0.f);
  environment_ = sky || ground;
  if (sky) foliage_->prepareSkyLight(instances, progress);
  if (ground) foliage_->prepareGroundLight(instances, progress);
  if (!environment_) return;
  std::vector<std::size_t> changed;
  for (const std::size_t i : instances) {
    OfInstance& of = of_instances_[i];
    const std::array revisions{sky ? foliage_->skyLightRevision(i) : 0, ground ? foliage_->groundLightRevision(i) : 0};
    if (of.of_environment == revisions && of.ground_radiance == ground_radiance_) continue;
    of.of_environment = revisions;
    of.ground_radiance = ground_radiance_;
    of.environment.revision = newRevisions();
    changed.push_back(i);
  }
  tbb::parallel_for(std::size_t{0}, changed.size(), [&](std::size_t k) {
    const std::size_t i = changed[k], prototype = foliage_->prototypeOf(i);
    const CellGrid& cells = foliage_->cellsMade(prototype);
    std::vector<glm::vec3>& values = of_instances_[i].environment.values;
    values.assign(cells.count(), glm::vec3(0.f));
    for (std::size_t cell = 0; cell < cells.active.size(); ++cell) {
      glm::vec3& value = values[cells.active[cell]];
      if (sky) value += foliage_->skyLight(i)[cell];
      if (ground) value += ground_radiance_ * foliage_->groundLight(i)[cell];
    }
  });
}

void StandGeometry::update(const Scene& scene, const GeometryNeeds& needs,
                           std::optional<std::span<const std::size_t>> trees, const Progress& progress,
                           const Progress& field_progress) {
  costs_before_ = costs();
  field_told_ = false;
  light_seconds_ = compensation_seconds_ = 0.;
  requireSurfaces(scene);
  updateKinds(scene);
  updateLights(scene);
  for (std::size_t kind = 0; kind < kinds_.size(); ++kind) {
    if (!kinds_[kind].stands) continue;
    OfKind& of_kind = of_kinds_[kind];
    foliage_->setLeaf(of_kind.prototype, scene.kinds[kinds_[kind].kind].leaf);
    of_kind.cells = &foliage_->cells(of_kind.prototype);
    const Stopwatch watch(light_seconds_);
    for (std::size_t light = 0; light < lights_.size(); ++light)
      of_kind.lights[light] = &foliage_->lightMap(of_kind.prototype, light);
  }

  std::vector<std::size_t> instances;
  if (trees)
    for (const std::size_t tree : *trees) instances.push_back(trees_.instance(tree));
  else
    for (std::size_t tree = 0; tree < scene.stand.trees.size(); ++tree) instances.push_back(trees_.instance(tree));
  const auto keep = [&](std::size_t instance, std::uint64_t revision, const auto& of_active, auto& cells) {
    if (cells.revision == revision) return;
    const std::size_t prototype = foliage_->prototypeOf(instance);
    cells.values = spread(foliage_->cells(prototype), of_active);
    cells.revision = revision;
  };
  if (needs.compensation && !lights_.empty()) {
    const Stopwatch watch(compensation_seconds_);
    foliage_->prepareCompensation(instances, progress);
    for (const std::size_t i : instances)
      for (std::size_t light = 0; light < lights_.size(); ++light)
        keep(i, foliage_->compensationRevision(i, light), foliage_->compensation(i, light),
             of_instances_[i].compensation[light]);
  }
  updateGround(scene, needs, progress);
  updateEnvironment(instances, needs, progress);
  if (!needs.field) return;
  if (!field_) field_ = std::make_unique<StandField>();
  field_->update(scene, needs.preview ? FieldBy::cells : FieldBy::lines, field_progress,
                 scene.ground_albedo == glm::vec3(0.f) ? GroundGrid{} : foliage_->ground(), trees);
  field_told_ = true;
}

bool StandGeometry::fieldUpToDate(const Scene& scene) const {
  return field_ && field_->upToDate(scene);
}

std::span<const float> StandGeometry::compensation(std::size_t tree, std::size_t light) const {
  return of_instances_[trees_.instance(tree)].compensation[light].values;
}
std::span<const glm::vec3> StandGeometry::skyLight(std::size_t tree) const {
  if (!environment_) return {};
  return of_instances_[trees_.instance(tree)].environment.values;
}

std::uint64_t StandGeometry::lightRevision(std::size_t kind, std::size_t light) const {
  return kinds_[kind].stands ? foliage_->lightMapRevision(of_kinds_[kind].prototype, light) : 0;
}
std::uint64_t StandGeometry::compensationRevision(std::size_t tree, std::size_t light) const {
  return of_instances_[trees_.instance(tree)].compensation[light].revision;
}
std::uint64_t StandGeometry::skyLightRevision(std::size_t tree) const {
  return environment_ ? of_instances_[trees_.instance(tree)].environment.revision : 0;
}

std::vector<ProductCost> StandGeometry::costs() const {
  std::vector<ProductCost> costs = foliage_->costs();
  if (field_)
    for (ProductCost& cost : field_->costs()) costs.push_back(std::move(cost));
  return costs;
}

std::vector<ProductCost> StandGeometry::lastCosts() const {
  std::vector<ProductCost> costs = this->costs();
  for (std::size_t i = 0; i < costs_before_.size(); ++i) {
    costs[i].made -= costs_before_[i].made;
    costs[i].reused -= costs_before_[i].reused;
    costs[i].adjusted -= costs_before_[i].adjusted;
    costs[i].skipped -= costs_before_[i].skipped;
    costs[i].seconds -= costs_before_[i].seconds;
  }
  return costs;
}

}  // namespace sunfleck
