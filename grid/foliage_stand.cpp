#include "grid/foliage_stand.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "core/require.hpp"
#include "core/stand.hpp"
#include "grid/neighbours.hpp"

namespace sunfleck {
namespace {

constexpr float kFarthest = 1e6f;    // from the origin [m]
constexpr float kUnitError = 1e-4f;  // of the square of a direction's length

void requirePosition(const glm::vec3& position) {
  for (int axis = 0; axis < 3; ++axis)
    require(std::abs(position[axis]) <= kFarthest, "position of a tree [m]", position[axis], "in [-1e6, 1e6]");
}

bool isPresent(const glm::vec3& position) {
  return !std::isnan(position.x);
}

std::vector<std::size_t> countedFrom0(std::size_t count) {
  std::vector<std::size_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), std::size_t{0});
  return numbers;
}

}  // namespace

FoliageStand::FoliageStand(FoliageEffort effort) : effort_(std::move(effort)) {
  assert(!effort_.axes.empty() && effort_.cells >= 1);
  sky_.assign(2 * effort_.axes.size(), glm::vec3(0.f));
  for (const Direction& direction : sampleDirections()) below_.emplace_back(direction.z > 0.f ? 0.f : 1.f);
  cells_ = graph_.add("cells");
  sample_axes_ = graph_.add("sample maps");
  light_maps_ = graph_.add("light maps");
  light_axes_ = graph_.add("light depths, trees");
  sample_depths_ = graph_.add("depths");
  light_depths_ = graph_.add("light depths");
  compensation_ = graph_.add("G");
  sky_light_ = graph_.add("sky light");
  ground_light_ = graph_.add("ground light");
  ground_ = graph_.add("light on the ground");
  graph_.resize(ground_, 1 + kMostLights);

  const std::size_t axes = effort_.axes.size();
  using Mark = ProductGraph::Mark;
  graph_.follows(sample_axes_, cells_, [axes](std::size_t prototype, const Mark& mark) {
    for (std::size_t axis = 0; axis < axes; ++axis) mark(prototype * axes + axis);
  });
  graph_.follows(light_maps_, cells_, [](std::size_t prototype, const Mark& mark) {
    for (std::size_t light = 0; light < kMostLights; ++light) mark(prototype * kMostLights + light);
  });
  graph_.follows(light_axes_, light_maps_, [](std::size_t member, const Mark& mark) { mark(member); });
  // Any tree may stand before any other.
  graph_.follows(sample_depths_, sample_axes_, [this, axes](std::size_t member, const Mark& mark) {
    for (std::size_t i = 0; i < placed_.size(); ++i) mark(i * axes + member % axes);
  });
  graph_.follows(light_depths_, light_axes_, [this](std::size_t prototype_light, const Mark& mark) {
    for (std::size_t i = 0; i < placed_.size(); ++i) mark(member(i, prototype_light % kMostLights));
  });
  graph_.follows(compensation_, light_depths_, [this](std::size_t member, const Mark& mark) {
    placed_[member / kMostLights].changed[member % kMostLights].clear();
    mark(member);
  });
  graph_.follows(compensation_, sample_depths_, [this, axes](std::size_t member, const Mark& mark) {
    for (std::size_t light = 0; light < kMostLights; ++light) {
      placed_[member / axes].changed[light].clear();
      mark(this->member(member / axes, light));
    }
  });
  for (const auto& [product, of_product] :
       {std::pair(sky_light_, kMostLights), std::pair(ground_light_, kMostLights + 1)})
    graph_.follows(product, sample_depths_, [this, axes, of_product](std::size_t member, const Mark& mark) {
      placed_[member / axes].changed[of_product].clear();
      mark(member / axes);
    });
  graph_.follows(ground_, sample_axes_, [](std::size_t, const Mark& mark) { mark(0); });
  graph_.follows(ground_, light_axes_, [](std::size_t member, const Mark& mark) { mark(1 + member % kMostLights); });
}

void FoliageStand::requireFits(const TreeMesh& mesh) const {
  if (mesh.leaf_triangles.empty()) throw InvalidInput("the tree has no leaves: at least one is needed");
  periodsAround({.period = period_}, leafBounds(mesh));
}

std::size_t FoliageStand::addPrototype(std::shared_ptr<const TreeMesh> mesh) {
  requireFits(*mesh);
  prototypes_.emplace_back().mesh = std::move(mesh);
  prototypes_.back().axes.resize(axisCount());
  graph_.resize(cells_, prototypes_.size());
  graph_.resize(sample_axes_, prototypes_.size() * effort_.axes.size());
  graph_.resize(light_maps_, prototypes_.size() * kMostLights);
  graph_.resize(light_axes_, prototypes_.size() * kMostLights);
  seen_from_.push_back(0.f);
  return prototypes_.size() - 1;
}

void FoliageStand::replacePrototype(std::size_t prototype, std::shared_ptr<const TreeMesh> mesh) {
  requireFits(*mesh);
  prototypes_[prototype].mesh = std::move(mesh);
  graph_.touch(cells_, prototype);
}

void FoliageStand::setLeaf(std::size_t prototype, const std::array<LeafOptics, kBands>& leaf) {
  for (const LeafOptics& of_band : leaf) validate(of_band);
  Prototype& p = prototypes_[prototype];
  if (leaf == p.leaf) return;
  p.leaf = leaf;
  for (std::size_t i = 0; i < placed_.size(); ++i)
    if (placed_[i].prototype == prototype) {
      placed_[i].changed[kMostLights].clear();
      placed_[i].changed[kMostLights + 1].clear();
      graph_.touch(sky_light_, i);
      graph_.touch(ground_light_, i);
    }
  graph_.touchAll(ground_);
}

std::size_t FoliageStand::add(std::size_t prototype, const glm::vec3& position) {
  requirePosition(position);
  placed_.emplace_back().prototype = prototype;
  positions_.emplace_back(std::numeric_limits<float>::quiet_NaN());
  graph_.resize(sample_depths_, placed_.size() * effort_.axes.size());
  graph_.resize(light_depths_, placed_.size() * kMostLights);
  graph_.resize(compensation_, placed_.size() * kMostLights);
  graph_.resize(sky_light_, placed_.size());
  graph_.resize(ground_light_, placed_.size());
  move(placed_.size() - 1, position);
  return placed_.size() - 1;
}

void FoliageStand::move(std::size_t instance, const glm::vec3& position) {
  requirePosition(position);
  if (positions_[instance] == position) return;
  const glm::vec3 before = positions_[instance];
  changes_.push_back({instance, isPresent(before) ? std::optional(before) : std::nullopt, position});
  positions_[instance] = position;
  graph_.touchAll(ground_);
  for (std::size_t axis = 0; axis < effort_.axes.size(); ++axis)
    graph_.touch(sample_depths_, instance * effort_.axes.size() + axis);
  for (std::size_t light = 0; light < kMostLights; ++light) graph_.touch(light_depths_, member(instance, light));
}

void FoliageStand::remove(std::size_t instance) {
  if (!isPresent(positions_[instance])) return;
  changes_.push_back({instance, positions_[instance], std::nullopt});
  positions_[instance] = glm::vec3(std::numeric_limits<float>::quiet_NaN());
  placed_[instance] = {.prototype = placed_[instance].prototype};
  graph_.touchAll(ground_);
}

void FoliageStand::setPeriod(std::optional<glm::vec2> period) {
  if (period == period_) return;
  if (period)
    for (int axis = 0; axis < 2; ++axis)
      require((*period)[axis] > 0.f && (*period)[axis] <= kFarthest, "period [m]", (*period)[axis], "in (0, 1e6]");
  for (const std::size_t p : standingPrototypes()) periodsAround({.period = period}, leafBounds(*prototypes_[p].mesh));
  period_ = period;
  touchDepths();
}

void FoliageStand::setLights(std::span<const Direction> lights) {
  require(lights.size() <= kMostLights, "number of lights", lights.size(), "at most " + std::to_string(kMostLights));
  for (const Direction& light : lights)
    require(std::abs(glm::dot(light, light) - 1.f) < kUnitError, "length of a light's direction", glm::length(light),
            "1");
  for (std::size_t light = 0; light < lights.size(); ++light) {
    if (light < lights_.size() && lights_[light] == lights[light]) continue;
    for (std::size_t prototype = 0; prototype < prototypes_.size(); ++prototype)
      graph_.touch(light_maps_, member(prototype, light));
  }
  lights_.assign(lights.begin(), lights.end());
}

void FoliageStand::setSky(std::span<const glm::vec3> radiance) {
  require(radiance.size() == sky_.size(), "number of directions of the sky", radiance.size(),
          "that of the sample directions, " + std::to_string(sky_.size()));
  for (const glm::vec3& from : radiance)
    for (int band = 0; band < kBands; ++band)
      require(from[band] >= 0.f && std::isfinite(from[band]), "radiance of the sky", from[band], ">= 0 and finite");
  if (std::equal(radiance.begin(), radiance.end(), sky_.begin())) return;
  sky_.assign(radiance.begin(), radiance.end());
  for (Placed& placed : placed_) placed.changed[kMostLights].clear();
  graph_.touchAll(sky_light_);
  graph_.touch(ground_, 0);
}

void FoliageStand::setGround(const GroundGrid& ground) {
  if (ground == ground_grid_) return;
  ground_grid_ = ground;
  graph_.touchAll(ground_);
}

std::vector<Direction> FoliageStand::sampleDirections() const {
  std::vector<Direction> directions;
  for (const Direction& axis : effort_.axes) directions.insert(directions.end(), {axis, -axis});
  return directions;
}

std::vector<std::size_t> FoliageStand::standingPrototypes() const {
  std::vector<char> stands(prototypes_.size(), 0);
  for (const std::size_t i : allInstances()) stands[placed_[i].prototype] = 1;
  std::vector<std::size_t> standing;
  for (std::size_t p = 0; p < stands.size(); ++p)
    if (stands[p]) standing.push_back(p);
  return standing;
}

std::vector<std::size_t> FoliageStand::allInstances() const {
  return present(countedFrom0(placed_.size()));
}

std::vector<std::size_t> FoliageStand::present(std::span<const std::size_t> instances) const {
  std::vector<std::size_t> result;
  std::copy_if(instances.begin(), instances.end(), std::back_inserter(result),
               [&](std::size_t i) { return isPresent(positions_[i]); });
  return result;
}

std::vector<std::size_t> FoliageStand::ofLights(std::span<const std::size_t> owners) const {
  std::vector<std::size_t> members;
  for (const std::size_t owner : owners)
    for (std::size_t light = 0; light < lights_.size(); ++light) members.push_back(member(owner, light));
  return members;
}

std::span<FixedDepth> FoliageStand::row(Placed& placed, std::size_t axis, bool before) {
  const std::size_t cells = prototypes_[placed.prototype].cells.active.size();
  return std::span(placed.depths).subspan((2 * axis + (before ? 1 : 0)) * cells, cells);
}
std::span<const FixedDepth> FoliageStand::row(const Placed& placed, std::size_t axis, bool before) const {
  const std::size_t cells = prototypes_[placed.prototype].cells.active.size();
  return std::span(placed.depths).subspan((2 * axis + (before ? 1 : 0)) * cells, cells);
}

std::span<const FixedDepth> FoliageStand::depths(std::size_t instance, std::size_t direction) const {
  return row(placed_[instance], direction / 2, direction % 2 == 1);
}
std::span<const FixedDepth> FoliageStand::lightDepths(std::size_t instance, std::size_t light) const {
  return row(placed_[instance], effort_.axes.size() + light, true);
}
std::span<const FixedDepth> FoliageStand::depthsBeyond(std::size_t instance, std::size_t light) const {
  return row(placed_[instance], effort_.axes.size() + light, false);
}
std::span<const float> FoliageStand::compensation(std::size_t instance, std::size_t light) const {
  return placed_[instance].compensation[light];
}
std::span<const glm::vec3> FoliageStand::skyLight(std::size_t instance) const {
  return placed_[instance].environment[0];
}
std::span<const glm::vec3> FoliageStand::groundLight(std::size_t instance) const {
  return placed_[instance].environment[1];
}

std::size_t FoliageStand::memoryBytes() const {
  std::size_t bytes = 0;
  for (const Prototype& p : prototypes_) {
    bytes += p.cells.slot.size() * sizeof(std::uint32_t) + p.cells.active.size() * sizeof(std::uint32_t);
    for (const auto& axis : p.axes) bytes += axis ? axis->memoryBytes() : 0;
    for (const auto& map : p.light_maps)
      if (map) bytes += map->crossings().size_bytes() + map->first().size_bytes() + map->woodDepth().size_bytes();
  }
  for (const Placed& placed : placed_) {
    bytes += placed.depths.capacity() * sizeof(FixedDepth);
    for (const auto& light : placed.environment) bytes += light.capacity() * sizeof(glm::vec3);
    for (const auto& g : placed.compensation) bytes += g.capacity() * sizeof(float);
  }
  return bytes;
}

}  // namespace sunfleck
