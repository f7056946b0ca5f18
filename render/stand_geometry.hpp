#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/progress.hpp"
#include "grid/foliage_stand.hpp"
#include "render/model.hpp"
#include "render/scene.hpp"
#include "render/stand_trees.hpp"

namespace sunfleck {

class StandField;

// How finely the geometry is sampled.
struct GeometryEffort {
  int light_resolution = 512;   // pixels along the longer side of the light's deep opacity map
  int sample_directions = 22;   // of the G-factor, even: both directions of half as many axes
  int sample_resolution = 256;  // pixels along the longer side of each of their maps
  int cells = 16;               // along the longest side of a tree

  bool operator==(const GeometryEffort&) const = default;
};

// The models hold numbers for every leaf of every tree; pictures for every cell.
inline constexpr std::size_t kMostTrees = 1024, kMostDrawnTrees = 16'384;
// Trees of a kind that are turned differently count as kinds of their own: each has its maps.
inline constexpr std::size_t kMostKinds = 64;

// Throws InvalidInput on a stand that cannot be drawn by the models: one of leaves that masks cut out, on a ground that
// is not Lambert's, with more than kMostDrawnTrees trees or kMostKinds kinds, with a period much shorter than the trees
// are wide, or with heaps of trees in one place.
void requireDrawable(const Scene& scene);
// The same on a scene whose leaves' irradiance the models do not tell: also one with more than kMostTrees trees, with
// glossy leaves, with a sky, or another light than one sun of irradiance 1 that is a point.
void requireModelled(const Scene& scene);
// Throws InvalidInput where masks cut out the scene's leaves: `what` would take their whole triangles.
void requireWholeLeaves(const Scene& scene, const std::string& what);

// What is wanted besides the lights' maps.
struct GeometryNeeds {
  bool compensation = true;  // G
  bool sky_light = true;     // where a sky shines: of the cells and, where the ground reflects, of the ground
  bool ground_light = true;  // what the ground sends back to the cells, where it reflects
  bool field = false;        // the light field, of all trees; of the sky then what comes to the ground
  bool preview = false;      // of the field on cells alone: in a tenth of the time, and some per cent off
};
GeometryNeeds needsOf(Model model);

// A sun that shines.
struct StandLight {
  std::size_t sun = 0;  // of the scene's
  Direction along{0.f, 0.f, -1.f};
  glm::vec3 irradiance{1.f};  // of a plane that faces it, per band [1]
};

// (D12) What the ground receives of the sky. Beyond the cells it lies open; with a period they are those of one period.
struct GroundSky {
  GroundGrid grid{};
  std::span<const glm::vec3> irradiance{};  // of each cell, per band [1]; empty where nothing is in the way
  glm::vec3 open{0.f};                      // of open ground [1]
  std::uint64_t revision = 0;               // another number whenever the cells' are others
};

// Trees that share maps and cells: of one kind of the scene, turned alike.
struct StandKind {
  std::uint32_t kind = 0;                // of the scene's
  float rotation = 0.f;                  // [rad]
  std::shared_ptr<const TreeMesh> mesh;  // turned
  bool stands = false;                   // whether there is a tree of it; none of what follows is told of others
};

// What leaves and fragments read to be shaded: the lights, each kind's maps along them, its cells, and for each tree G
// and sky light of the cells. It serves one scene after another and computes only what the next one changes.
class StandGeometry {
 public:
  //   light_map  makes the lights' maps, called by the thread that updates; none: the processor does
  explicit StandGeometry(const GeometryEffort& effort = {}, MapMaker light_map = {});
  ~StandGeometry();
  StandGeometry(StandGeometry&&) noexcept;
  StandGeometry& operator=(StandGeometry&&) noexcept;

  // Brings the lights' maps up to date for the scene, and what else is needed of the trees listed. Throws InvalidInput
  // as requireDrawable() and sunAndSky() do, and std::runtime_error("interrupted") when `progress` ends it: what is
  // told then may be of the former scene.
  //   trees           of the scene's stand; none: all
  //   field_progress  of the light field, which comes last
  void update(const Scene& scene, const GeometryNeeds& needs = {},
              std::optional<std::span<const std::size_t>> trees = std::nullopt, const Progress& progress = {},
              const Progress& field_progress = {});
  // Whether the light field along lines is up to date for the scene, but for sums.
  bool fieldUpToDate(const Scene& scene) const;

  const GeometryEffort& effort() const { return effort_; }
  std::span<const StandLight> lights() const { return lights_; }             // at most kMostSuns; none by night
  const std::shared_ptr<const SkyMap>& sky() const { return shining_.sky; }  // none where it is black

  std::span<const StandKind> kinds() const { return kinds_; }  // the scene's own, not turned; then those turned
  std::size_t kindOf(std::size_t tree) const { return kind_of_tree_[tree]; }
  const CellGrid& cells(std::size_t kind) const { return *of_kinds_[kind].cells; }
  const DeepOpacityMap& light(std::size_t kind, std::size_t light) const { return *of_kinds_[kind].lights[light]; }

  // Of all cells of a tree, active or not; of a tree that was not listed as it was before, empty where it never was.
  //   (D5) G [1], 0 .. 1
  std::span<const float> compensation(std::size_t tree, std::size_t light) const;
  //   (D10) mean radiance of the light of sky and ground, per band [1/sr]; empty where there is none, or none is needed
  std::span<const glm::vec3> skyLight(std::size_t tree) const;

  // The light field, if the last update brought it up to date.
  const StandField* field() const { return field_told_ ? field_.get() : nullptr; }

  const GroundSky& groundSky() const { return ground_sky_; }

  // Another number whenever the content is another, in whichever StandGeometry; 0: there is none.
  std::uint64_t lightRevision(std::size_t kind, std::size_t light) const;
  std::uint64_t compensationRevision(std::size_t tree, std::size_t light) const;
  std::uint64_t skyLightRevision(std::size_t tree) const;

  double lightSeconds() const { return light_seconds_; }  // wall time of the last update for the lights' maps
  double compensationSeconds() const { return compensation_seconds_; }  // and for all that G needs
  std::vector<ProductCost> costs() const;                               // of all updates
  std::vector<ProductCost> lastCosts() const;                           // of the last one

 private:
  // What FoliageStand has as a prototype.
  struct Prototype {
    std::shared_ptr<const TreeMesh> mesh;  // not turned
    std::uint32_t kind = 0;
    float rotation = 0.f;
    std::shared_ptr<const TreeMesh> turned;
    bool used = false;
  };
  struct OfKind {
    std::size_t prototype = 0;
    const CellGrid* cells = nullptr;
    std::array<const DeepOpacityMap*, kMostSuns> lights{};
  };
  // Values of all cells.
  template <typename Value>
  struct Cells {
    std::uint64_t revision = 0;
    std::vector<Value> values;
  };
  struct OfInstance {
    std::array<Cells<float>, kMostSuns> compensation;
    Cells<glm::vec3> environment;
    std::array<std::uint64_t, 2> of_environment{};  // revisions of sky light and ground light
    glm::vec3 ground_radiance{0.f};
  };

  void updateKinds(const Scene& scene);
  void updatePrototypes(const Scene& scene);
  void updateLights(const Scene& scene);
  void updateGround(const Scene& scene, const GeometryNeeds& needs, const Progress& progress);
  void updateEnvironment(std::span<const std::size_t> instances, const GeometryNeeds& needs, const Progress& progress);

  GeometryEffort effort_;
  std::unique_ptr<FoliageStand> foliage_;
  std::unique_ptr<StandField> field_;  // made when it is first needed
  bool field_told_ = false;
  std::vector<Prototype> prototypes_;
  StandTrees trees_;
  std::vector<StandKind> kinds_;
  std::vector<OfKind> of_kinds_;
  std::vector<std::size_t> kind_of_tree_;
  std::vector<OfInstance> of_instances_;

  Stand stand_{.trees = {}};  // that kinds and trees are up to date for
  std::vector<std::shared_ptr<const TreeMesh>> meshes_;
  SceneSky sky_;  // that the lights are up to date for
  std::vector<Sun> suns_;
  SunAndSky shining_;
  std::vector<StandLight> lights_;
  glm::vec3 sky_factor_{0.f};  // from the sky's light on level ground by sample directions to the whole [1]
  Bounds leaves_;              // about the trees [m]
  GroundSky ground_sky_;
  std::vector<glm::vec3> ground_irradiance_;
  glm::vec3 ground_radiance_{0.f};
  bool environment_ = false;  // whether the cells have light of sky or ground

  std::vector<ProductCost> costs_before_;
  double light_seconds_ = 0., compensation_seconds_ = 0.;
};

}  // namespace sunfleck
