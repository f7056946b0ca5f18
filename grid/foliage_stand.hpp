#pragma once

#include <array>
#include <atomic>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/leaf_optics.hpp"
#include "core/progress.hpp"
#include "core/tree_mesh.hpp"
#include "grid/cell_grid.hpp"
#include "grid/deep_opacity_map.hpp"
#include "grid/product_graph.hpp"
#include "grid/stand_index.hpp"
#include "grid/tree_depths.hpp"

namespace sunfleck {

// How finely a stand is sampled.
struct FoliageEffort {
  std::vector<Direction> axes = spreadAxes(11);  // the sample directions are both directions of each
  int sample_resolution = 256;                   // pixels along the longer side of the maps along them
  int light_resolution = 512;                    // pixels along the longer side of a light's maps
  int cells = 16;                                // along the longest side of a tree
  MapMaker light_map{};  // of a light's maps, called where they are asked for; none: by the processor
};

// Level ground in cells. Cell (x, y) is number y * size.x + x.
struct GroundGrid {
  glm::vec2 low{0.f};        // corner of cell (0, 0) [m]
  float height = 0.f;        // [m]
  glm::vec2 cell_size{1.f};  // [m]
  glm::ivec2 size{0};        // [cell]
  bool operator==(const GroundGrid&) const = default;
};

// A stand of trees, copies of some prototypes, and what the models need to know of it: the steps 1 to 5 of Shinya et
// al. 2013, section 5.4. Trees may be moved, added and removed, lights turned, leaves and sky exchanged. Each such
// change only says what has become stale; a product is computed when it is asked for, where it is asked for, and as far
// as it is stale. The products are the same to the bit whatever the order of the trees, the number of threads and the
// changes on the way.
//
// Prototypes, instances, lights are told by their numbers, in the order in which they were added. Not to be used by
// several threads at once; it uses all cores itself.
class FoliageStand {
 public:
  static constexpr std::size_t kMostLights = 4;

  explicit FoliageStand(FoliageEffort effort = {});
  FoliageStand(const FoliageStand&) = delete;
  FoliageStand& operator=(const FoliageStand&) = delete;

  // Throw InvalidInput on a mesh without leaves, or one too wide for the period.
  std::size_t addPrototype(std::shared_ptr<const TreeMesh> mesh);
  void replacePrototype(std::size_t prototype, std::shared_ptr<const TreeMesh> mesh);
  void setLeaf(std::size_t prototype, const std::array<LeafOptics, kBands>& leaf);

  // Positions [m] are added to the prototype's vertices. Throw InvalidInput when they are not finite or beyond 1e6 m.
  std::size_t add(std::size_t prototype, const glm::vec3& position);
  void move(std::size_t instance, const glm::vec3& position);
  void remove(std::size_t instance);  // its number stays, and stands for nothing
  // Makes the stand repeat in x and y; see periodsAround() of grid/neighbours.hpp on how far. Throws InvalidInput on a
  // period that is not in (0, 1e6] m or too short for the trees.
  void setPeriod(std::optional<glm::vec2> period);

  // Directions in which the lights travel, at most kMostLights. Only those that change make something stale. Throws
  // InvalidInput on more, and on a direction that is no unit vector.
  void setLights(std::span<const Direction> lights);
  // Radiance that arrives from each of sampleDirections(), per band [W m^-2 sr^-1]. Throws InvalidInput on another
  // number of them, and on a value that is negative or not finite.
  void setSky(std::span<const glm::vec3> radiance);

  // Where light on the ground is wanted. It lies below all leaves.
  void setGround(const GroundGrid& ground);
  const GroundGrid& ground() const { return ground_grid_; }

  // Outward from a place: each axis, followed by the direction against it.
  std::vector<Direction> sampleDirections() const;

  std::size_t instances() const { return placed_.size(); }
  std::size_t prototypeOf(std::size_t instance) const { return placed_[instance].prototype; }
  const CellGrid& cells(std::size_t prototype);
  const CellGrid& cellsMade(std::size_t prototype) const { return prototypes_[prototype].cells; }  // as they last were
  // (D3) The prototype's deep opacity map along a light.
  const DeepOpacityMap& lightMap(std::size_t prototype, std::size_t light);

  // Each of these brings its product up to date for the instances listed. Removed instances are passed over. Throw
  // std::runtime_error("interrupted") when `progress` ends them; what is done stays.
  //   (D4) optical depths, and (D5) G for each light
  void prepareCompensation(std::span<const std::size_t> instances, const Progress& progress = {});
  //   (D10) environment light: of the sky, and of a ground that sends the same radiance up from everywhere
  void prepareSkyLight(std::span<const std::size_t> instances, const Progress& progress = {});
  void prepareGroundLight(std::span<const std::size_t> instances, const Progress& progress = {});
  //   (D12) what reaches the ground, of the sky and of each light
  void prepareGround(const Progress& progress = {});
  std::vector<std::size_t> allInstances() const;

  // Of the active cells of an instance, in their order; prepared before.
  //   (D4) Crossings from the cells outward along sampleDirections()[direction] [step]
  std::span<const FixedDepth> depths(std::size_t instance, std::size_t direction) const;
  //   (D4) the same between a light and the cells, and beyond them
  std::span<const FixedDepth> lightDepths(std::size_t instance, std::size_t light) const;
  std::span<const FixedDepth> depthsBeyond(std::size_t instance, std::size_t light) const;
  //   (D5) G for a light [1], 0 .. 1; 0 where the light comes through kDeepest steps
  std::span<const float> compensation(std::size_t instance, std::size_t light) const;
  //   (D10) mean radiance of the environment's light over all directions, per band [W m^-2 sr^-1]
  std::span<const glm::vec3> skyLight(std::size_t instance) const;
  //   (D10) the same, of a ground of radiance 1 [1]
  std::span<const glm::vec3> groundLight(std::size_t instance) const;
  // (D12) Of the ground's cells, per band: irradiance by the sky [W m^-2], and the share of each light that arrives [1]
  std::span<const glm::vec3> groundSky() const { return ground_sky_; }
  std::span<const glm::vec3> groundShare(std::size_t light) const { return ground_shares_[light]; }

  // Another number whenever the product is made anew; 0: not yet made.
  std::uint64_t lightMapRevision(std::size_t prototype, std::size_t light) const {
    return graph_.revision(light_maps_, member(prototype, light));
  }
  std::uint64_t compensationRevision(std::size_t instance, std::size_t light) const {
    return graph_.revision(compensation_, member(instance, light));
  }
  std::uint64_t skyLightRevision(std::size_t instance) const { return graph_.revision(sky_light_, instance); }
  std::uint64_t groundLightRevision(std::size_t instance) const { return graph_.revision(ground_light_, instance); }
  std::uint64_t groundSkyRevision() const { return graph_.revision(ground_, 0); }
  std::uint64_t groundShareRevision(std::size_t light) const { return graph_.revision(ground_, 1 + light); }

  // What has been made and what was reused since this stand was made.
  std::vector<ProductCost> costs() const { return graph_.costs(); }
  std::size_t memoryBytes() const;  // of all products kept

 private:
  struct Prototype {
    std::shared_ptr<const TreeMesh> mesh;
    std::array<LeafOptics, kBands> leaf{};
    CellGrid cells;
    std::vector<std::optional<TreeDepths>> axes;  // along each sample axis, then along each light
    std::array<std::optional<DeepOpacityMap>, kMostLights> light_maps;
  };
  struct Placed {
    std::size_t prototype = 0;
    std::vector<FixedDepth> depths;  // rows of active cells: beyond and before for each axis, as in Prototype::axes
    std::array<std::vector<float>, kMostLights> compensation;
    std::array<std::vector<glm::vec3>, 2> environment;  // light of the sky, of the ground
    // Cells whose depths changed since; empty: all. For each light, then for the sky, for the ground.
    std::array<std::vector<char>, kMostLights + 2> changed;
  };
  struct Change {
    std::size_t instance;
    std::optional<glm::vec3> from, to;
  };
  // What a changed tree adds to an instance's sums along an axis, or takes from them.
  struct Part {
    std::size_t instance, axis, source;
    glm::vec3 displacement;  // of the source from the instance [m]
    std::int32_t times;
  };
  struct Adjusted {
    std::size_t instance = 0;
    std::vector<char> by_samples;                         // cells whose depths changed along any sample axis
    std::array<std::vector<char>, kMostLights> by_light;  // along each light
    std::vector<std::size_t> lost;                        // axes whose sums cannot be told from the stored ones
    std::size_t sample_rows = 0, light_rows = 0;
  };

  std::size_t axisCount() const { return effort_.axes.size() + kMostLights; }
  std::size_t member(std::size_t owner, std::size_t light) const { return owner * kMostLights + light; }
  std::span<FixedDepth> row(Placed& placed, std::size_t axis, bool before);
  std::span<const FixedDepth> row(const Placed& placed, std::size_t axis, bool before) const;

  void requireFits(const TreeMesh& mesh) const;
  std::vector<std::size_t> present(std::span<const std::size_t> instances) const;
  std::vector<std::size_t> ofLights(std::span<const std::size_t> owners) const;
  std::vector<std::size_t> standingPrototypes() const;  // those of which there is an instance
  void prepareDepths(std::span<const std::size_t> instances, bool with_lights, const Progress& progress);
  void applyChanges(std::span<const std::size_t> standing);
  std::vector<Part> changedParts(std::span<const std::size_t> standing);
  void adjustSums(ProductGraph::Product depths, std::span<const Part> parts);  // all of these depths
  Adjusted adjust(std::span<const Part> parts);
  void passOn(const Adjusted& adjusted);
  void touchDepths();
  void touchDepths(std::size_t instance, std::size_t axis);
  void requireMemory(std::span<const std::size_t> instances, std::span<const std::size_t> standing) const;
  void makeDepths(std::size_t instance, std::size_t axis);
  void makeCompensation(std::size_t instance, std::size_t light);
  void makeEnvironment(std::size_t instance, std::size_t which, std::span<const glm::vec3> radiance);
  void makeGround(std::size_t member);
  Bounds reached(const CellGrid& receiver) const;

  FoliageEffort effort_;
  std::vector<Prototype> prototypes_;
  std::vector<float> seen_from_;  // sides of their cells [m]; 0 of those that never stood
  std::vector<Placed> placed_;
  std::vector<glm::vec3> positions_;  // of the instances [m]; not a number where there is none
  std::optional<glm::vec2> period_;
  std::vector<Direction> lights_;
  std::vector<glm::vec3> sky_, below_;  // radiance by sample directions, below_: 1 from below the horizon
  GroundGrid ground_grid_;
  std::vector<glm::vec3> ground_sky_;
  std::array<std::vector<glm::vec3>, kMostLights> ground_shares_;
  std::vector<Change> changes_;  // of positions, not yet in the index
  bool index_stale_ = true;
  glm::ivec2 around_{0};  // periods away up to which the index has copies
  StandIndex index_;

  std::atomic<std::size_t> unlit_{0};  // cells found without light in the last preparation
  ProductGraph graph_;
  ProductGraph::Product cells_, sample_axes_, light_maps_, light_axes_, sample_depths_, light_depths_, compensation_,
      sky_light_, ground_light_, ground_;
};

}  // namespace sunfleck
