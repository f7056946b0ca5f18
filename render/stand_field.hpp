#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/progress.hpp"
#include "field/cell_field.hpp"
#include "field/large_stand.hpp"
#include "field/leaf_field.hpp"
#include "render/scene.hpp"

namespace sunfleck {

// Whether the trees of a scene, together, have no more leaves than the light field can tell of one by one; throws
// InvalidInput where they have. Of those of a picture it takes any number.
bool fieldFits(const Scene& scene);
void requireField(const Scene& scene);

// How the field is solved: along lines, exactly but for their number; or on cells alone, as a preview.
enum class FieldBy { lines, cells };

// On cells as a preview has them: 16 along a tree, and a coarser picture from the sun.
inline constexpr CellFieldEffort kPreviewEffort{.direct = {.pixels = 16.f}, .solver = {.error = 0.01f}};

// What shines on a scene's trees, and what they do to light, as the field reads it. Throws InvalidInput as sunAndSky()
// does.
FieldLighting fieldLighting(const Scene& scene);

// (F26) The light field of a scene's stand, kept for pictures: what comes to either side of each place of each tree by
// all but the suns' direct light. A place is a leaf or, for the wood, a cell of the tree.
class StandField {
 public:
  explicit StandField(const FieldEffort& effort = {}, const CellFieldEffort& cells = kPreviewEffort);

  // Brings it up to date for the scene. A stand of more leaves than can be solved as one is solved in cells, and leaf
  // by leaf only where trees are asked for (F28), whichever way is asked for. Throws InvalidInput as LeafField,
  // CellField or LargeStandField, requireField() and sunAndSky() do, and std::runtime_error("interrupted") when
  // `progress` ends it: then nothing is told until the next update.
  //   ground  cells in which its light is told, but of a stand that cannot be solved as one; none: it is not
  //   trees   that a picture by the scene's camera shows; none: all. Of very many those nearest to the camera have a
  //           place for each leaf, the others for what lies together and faces alike.
  void update(const Scene& scene, FieldBy by = FieldBy::lines, const Progress& progress = {},
              const GroundGrid& ground = {}, std::optional<std::span<const std::size_t>> trees = std::nullopt);
  // Whether an update along lines would compute no product anew, or no preview would be sooner there.
  bool upToDate(const Scene& scene) const;
  FieldBy by() const { return by_; }  // what is told

  // Of each triangle of a kind of the scene, leaves before wood, its place, and that in trees that are far.
  std::span<const std::uint32_t> places(std::uint32_t kind) const { return kinds_[kind].places; }
  std::span<const std::uint32_t> farPlaces(std::uint32_t kind) const { return kinds_[kind].far_places; }
  bool isFar(std::size_t tree) const { return !far_.empty() && far_[tree]; }
  // Irradiance of the front and the back of each place of a tree, per band [1]; another revision whenever it is
  // another.
  std::span<const glm::vec3> sides(std::size_t tree) const { return sides_[tree]; }
  std::uint64_t revision() const { return revision_; }
  // (F31) Irradiance of each cell of the ground by what leaves and wood send down, per band [1].
  std::span<const glm::vec3> ground() const { return ground_; }

  const FieldResult& result() const { return *result_; }
  // Of the field along lines, "field: ...", on cells, "preview: ...", and of large stands.
  std::vector<ProductCost> costs() const;

 private:
  // The wood of a kind is lit as the leaves around it.
  struct Kind {
    std::shared_ptr<const TreeMesh> mesh;
    std::vector<std::uint32_t> places;
    std::vector<std::vector<std::uint32_t>> leaves_around;  // of each place beyond the leaves
    std::vector<std::uint32_t> far_places;
  };
  static Kind kindOf(const std::shared_ptr<const TreeMesh>& mesh);
  FieldLighting lightingOf(const Scene& scene) const;

  void updateLarge(const Scene& scene, const FieldLighting& lighting, std::optional<std::span<const std::size_t>> trees,
                   const Progress& progress);

  FieldEffort effort_;
  SceneSky sky_;  // that sky_map_ was made of, with the sun that lights it
  Sun sky_sun_;
  std::shared_ptr<const SkyMap> sky_map_;
  LeafField field_;
  CellField on_cells_;
  FieldBy by_ = FieldBy::lines;
  std::unique_ptr<LargeStandField> large_;  // made when it is first needed
  std::vector<char> far_;                   // of each tree, where any is
  const FieldResult* result_ = nullptr;
  std::vector<Kind> kinds_;
  std::vector<std::vector<glm::vec3>> sides_;
  std::vector<glm::vec3> ground_;
  std::uint64_t revision_ = 0;
};

// (F27) Irradiance of each leaf by the light field, in a band, direct light included, both sides together per one-sided
// area: the mean over the stand's trees of the kind, kind after kind, as (R7) has that of the models [unit of the
// light].
std::vector<float> leafIrradiance(const FieldResult& field, const Scene& scene, int band);

// The same scene without its wood, which the other models do not know.
Scene withoutWood(const Scene& scene);

}  // namespace sunfleck
