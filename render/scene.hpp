#pragma once

#include <array>
#include <filesystem>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/directions.hpp"
#include "core/ground_texture.hpp"
#include "core/leaf_maps.hpp"
#include "core/leaf_optics.hpp"
#include "core/stand.hpp"
#include "core/tree_mesh.hpp"
#include "leaves/leaf_description.hpp"
#include "leaves/leaf_textures.hpp"
#include "plants/import.hpp"
#include "render/camera.hpp"
#include "render/scene_medium.hpp"
#include "render/scene_sky.hpp"
#include "scattering/rpv_ground.hpp"

namespace sunfleck {

// How to make a prototype again: grown, or read from a file; neither of one that was made by a program.
struct TreeRecipe {
  std::string species;  // its name or its parameter file (.toml), with its seed
  std::uint64_t seed = 1;
  std::filesystem::path file;  // with its rules
  ImportRules rules;
};

// leafAreaShares() of a mesh, at images of one size.
struct LeafShares {
  std::shared_ptr<const TreeMesh> mesh;
  int width = 1, height = 1;
  std::vector<float> at{1.f};
};

// A kind of tree: its prototype and its optics.
struct TreeKind {
  std::string name;    // what the scene's trees call it
  std::string source;  // what the leaves came from, for people: a file or a species with its seed
  TreeRecipe recipe;
  Dropped dropped;  // triangles of no area that the file held
  std::shared_ptr<const TreeMesh> mesh;
  LeafDescription description;  // how its leaves are told; by numbers unless it says more
  LeafTextures textures;        // what tells their places and sides apart
  BandOptics leaf;  // by numbers these; else what follows from the description in the scene's bands; with the gloss
  // Where textures say more (setLeaves() keeps these three): the leaf that they vary, what each place and side does, of
  // which `leaf` is the mean, and of which part of the leaf area each place is.
  BandOptics even;
  std::shared_ptr<const LeafMaps> maps;
  std::shared_ptr<const LeafShares> shares;
  glm::vec3 wood_reflectance{0.3f};  // Lambertian, per band [1], 0 .. 1

  // The leaf as it is told, before textures: what a person edits.
  const BandOptics& told() const { return textures.any() ? even : leaf; }
};

// A sun this low or lower has set: it gives no light. 89.9 degrees, also when rounded.
inline constexpr float kSunset = 1.5690511f;
inline constexpr std::size_t kMostSuns = 4;

// A light as far away as the sun.
struct Sun {
  float zenith = 0.f;         // [rad], 0 .. pi
  float azimuth = 0.f;        // where it stands, from +x towards +y [rad]
  glm::vec3 irradiance{1.f};  // of a plane that faces it, per band [1], 0 .. 10
  float diameter = 0.f;       // of its disc, 0: a point [rad]

  bool up() const { return zenith <= kSunset; }
  Direction light() const { return sunlight(zenith, azimuth); }  // in which its light travels
  bool operator==(const Sun&) const = default;
};

// Where to look from, kept under a name.
struct SavedCamera {
  std::string name;  // 1 .. kLongestCameraName bytes
  Camera camera;
  bool operator==(const SavedCamera&) const = default;
};
inline constexpr std::size_t kLongestCameraName = 64;

// What is simulated: kinds of trees, where they stand, the ground, the suns and the sky.
struct Scene {
  std::string name;
  std::string origin;                       // the file or the name it was read from, with which messages begin
  std::vector<TreeKind> kinds{TreeKind{}};  // at least one
  LightBands bands;                         // what the bands of leaves are that are told by contents; none: RGB
  Stand stand;
  std::vector<SceneMedium> media;  // of these, trace alone knows; trees may then be without leaves or without anything
  glm::vec3 ground_albedo{0.f};    // Lambertian, per band [1], 0 .. 1; other grounds, per band, in its place:
  std::optional<std::array<RpvGround, kBands>> ground_rpv;
  std::array<std::shared_ptr<const GroundTexture>, kBands> ground_texture;  // of all bands, or none
  std::string ground_texture_file;                                          // that they were read from
  std::vector<Sun> suns{Sun{}};  // 1 .. kMostSuns; the first is the one that lights the sky
  SceneSky sky;
  std::optional<Camera> camera;            // none: one that shows the whole stand
  std::vector<SavedCamera> saved_cameras;  // names differ

  const Sun& sun() const { return suns.front(); }
  const TreeKind& kindOf(const Placement& tree) const { return kinds[tree.kind]; }
};

// Sets what the kind's leaves do to light, from its mesh, description and textures: `leaf`, `even`, `maps` and
// `shares`. Shares are kept from one call to the next, as only another mesh or another size of images changes them:
// then it takes some 20 ms for images of 720 x 540.
//   told  reflectance and transmittance of leaves told by numbers, and the gloss; kind.told() keeps what they are
// Throws InvalidInput as bandOptics() and leafMaps() do, and leaves the kind as it was.
void setLeaves(TreeKind& kind, const LightBands& bands, const BandOptics& told);

std::vector<const TreeMesh*> meshes(const Scene& scene);  // of the kinds
// What the leaves of all kinds came from, for people.
std::string sourceOf(const Scene& scene);
// The camera of that name. Throws InvalidInput where none was saved under it.
const Camera& savedCamera(const Scene& scene, const std::string& name);
// Moves trees of a periodic stand by whole periods where they are spread over more than one: the stand is the same, and
// all its trees stand together.
void intoOnePeriod(Stand& stand);

Bounds bounds(const Scene& scene);    // of all trees of the stand and of its media [m]
Camera cameraOf(const Scene& scene);  // the scene's camera, or one that shows the whole stand
// The camera moved and widened so that the whole stand fills its picture; direction and pixels stay.
Camera showingAll(const Scene& scene, Camera camera);
// Trees of the stand of which the camera's picture may show something: themselves or, where the ground reflects, light
// that comes from their leaves down to it. All of them in a periodic stand, which is drawn with copies.
std::vector<std::size_t> treesInPicture(const Scene& scene, const Camera& camera);

}  // namespace sunfleck
