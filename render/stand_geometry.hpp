#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/progress.hpp"
#include "grid/foliage_stand.hpp"
#include "render/model.hpp"
#include "render/scene.hpp"

namespace sunfleck {

// How finely the geometry is sampled.
struct GeometryEffort {
  int light_resolution = 512;   // pixels along the longer side of the light's deep opacity map
  int sample_directions = 22;   // of the G-factor, even: both directions of half as many axes
  int sample_resolution = 256;  // pixels along the longer side of each of their maps
  int cells = 16;               // along the longest side of a tree
};

// The models hold numbers for every leaf of every tree.
inline constexpr std::size_t kMostTrees = 1024;

// Throws InvalidInput on a stand that the models cannot treat: one of several kinds of trees, one with a rotated tree,
// since a prototype's maps serve its translated copies only (Eq. 31), with more than kMostTrees trees, or with a period
// much shorter than the tree is wide.
void requireModelled(const Scene& scene);
// Throws InvalidInput where masks cut out the scene's leaves: `what` would take their whole triangles.
void requireWholeLeaves(const Scene& scene, const std::string& what);

// What leaves and fragments read to be shaded, whatever their optics: the prototype's map along the light, and the
// cells of each tree with their G-factors. It serves one scene after another and computes only what the next one
// changes.
class StandGeometry {
 public:
  explicit StandGeometry(const GeometryEffort& effort = {});

  // Brings the light's map up to date for the scene, and for a model with G the G of the trees listed. Throws
  // InvalidInput as requireModelled() does, and std::runtime_error("interrupted") when `progress` ends it.
  //   trees  of the scene's stand; none: all
  void update(const Scene& scene, Model model, std::optional<std::span<const std::size_t>> trees = std::nullopt,
              const Progress& progress = {});

  const DeepOpacityMap& light() const { return *light_; }  // along the scene's sun
  const CellGrid& cells() const { return *cells_; }        // of the prototype
  // Of each tree: G per cell [1], 0 .. 1, and 0 for trees that were not listed. Empty where the model has no G.
  const std::vector<std::vector<float>>& compensation() const { return compensation_; }
  double lightSeconds() const { return light_seconds_; }  // wall time of the last update for the light's map
  double compensationSeconds() const { return compensation_seconds_; }  // and for all that G needs
  std::vector<ProductCost> costs() const { return stand_->costs(); }    // of all updates

 private:
  GeometryEffort effort_;
  std::unique_ptr<FoliageStand> stand_;
  std::shared_ptr<const TreeMesh> tree_;
  const DeepOpacityMap* light_ = nullptr;
  const CellGrid* cells_ = nullptr;
  std::vector<std::vector<float>> compensation_;
  double light_seconds_ = 0., compensation_seconds_ = 0.;
};

}  // namespace sunfleck
