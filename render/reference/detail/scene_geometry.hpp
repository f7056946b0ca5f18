#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "render/reference/detail/embree_calls.hpp"
#include "render/reference/detail/facet.hpp"
#include "render/reference/detail/medium_field.hpp"
#include "render/reference/detail/ray_trees.hpp"
#include "render/reference/detail/stand_copies.hpp"
#include "render/reference/ray_scene.hpp"

namespace sunfleck {
namespace detail {

enum class Surface { none, leaf, wood, turbid_leaf, particle };

// What a ray meets first.
struct Hit {
  Surface surface = Surface::none;
  std::uint32_t kind = 0;   // of the tree; in a medium: which
  std::uint32_t leaf = 0;   // when a leaf: among those of all kinds, one kind after the other
  glm::vec3 position{0.f};  // on the surface; in a periodic stand inside the traced period [m]
  bool front = true;        // whether the ray came from the side that the corners turn about counter-clockwise
  glm::vec3 normal{0.f};    // unit, geometric, on the side the ray came from; of a particle: back along the ray
  std::uint32_t copy = 0, primitive = 0;  // when a leaf: of the stand's trees, and among the leaves of its kind
};

struct ReleaseDevice {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, ReleaseDevice>;
using EmbreeScene = std::unique_ptr<std::remove_pointer_t<RTCScene>, ReleaseScene>;

// The prototypes' triangles, and the stand of instances of them unless one stands alone.
struct Scenes {
  std::vector<EmbreeScene> prototypes;  // of each kind
  EmbreeScene instances;
  RTCScene root() const { return instances ? instances.get() : prototypes.front().get(); }
};

// Where leaf triangles lie in the images of their leaf, also what Embree's filter asks whether one is cut away where a
// ray meets it.
struct LeafImages {
  std::vector<std::shared_ptr<const LeafMask>> masks;
  std::vector<LeafPatch> patches;
  std::vector<std::uint32_t> patch_of_triangle;  // or TreeMesh::kNoPatch
  std::vector<glm::uvec3> triangles;             // corners
  const glm::vec3* vertices = nullptr;           // Embree's, about the kind's pivot [m]
};

// What a hit on a kind of tree is looked up in. A primitive is what Embree tests as one: a triangle, or two.
struct Prototype {
  // Of each primitive's two triangles, leaves first, alike where it is one: unit normal n, and n . x on it [m].
  std::vector<std::array<glm::vec4, 2>> planes;
  std::vector<std::uint32_t> first_triangle;     // of each primitive, among those of the leaves and then the wood
  std::vector<std::uint32_t> leaf_of_primitive;  // among the leaves of all kinds
  bool leaf_quads = false, wood_quads = false;   // whether Embree has them as quads
  std::unique_ptr<LeafImages> images;            // where any leaf triangle has a patch
  bool cut() const { return images && !images->masks.empty(); }
};

// What a ray met of a copy, and how far away.
struct Met {
  std::uint32_t copy, primitive;
  bool leaf;
  glm::vec4 plane;  // see Prototype::planes
  float distance;   // [m]
};

// A ray that would pass more periods than this without meeting anything is taken to leave the layer of leaves by the
// face it heads for: it is within 1e-4 (height of the layer / period) of horizontal.
inline constexpr int kMostPeriods = 10'000;

}  // namespace detail

// Embree's view of a stand. All positions are relative to `origin`.
struct RayScene::Geometry {
  Geometry(std::span<const TreeMesh* const> kinds, const Stand& stand, bool with_wood,
           const std::vector<TraceMedium>& of_media);

  // First surface on the way from `from` along the unit vector `direction`, no farther than `reach` [m], which counts
  // in stands without period and in those with media.
  detail::Hit closest(const glm::vec3& from, const glm::vec3& direction, detail::Coherence coherence,
                      float reach = std::numeric_limits<float>::infinity()) const;
  // Whether anything stands on that way.
  bool blocked(const glm::vec3& from, const glm::vec3& direction) const;

  // The same for up to kPacket rays at once, which is much faster where they lie side by side.
  static constexpr std::size_t kPacket = 16;
  void closest(std::span<const glm::vec3> from, std::span<const Direction> directions, std::span<const float> reach,
               std::span<detail::Hit> hits) const;
  // Of parallel rays; of those that are blocked already it is not asked for.
  void blocked(std::span<const glm::vec3> from, const glm::vec3& direction, std::span<bool> blocked) const;

  // (R14) Where a path meets something in a medium, whatever surfaces may stand before.
  struct Flight : detail::Collision {
    std::uint32_t medium = 0;
  };
  Flight fly(const glm::vec3& from, const glm::vec3& direction, detail::PathRandom& random) const;
  // What it meets there.
  detail::Hit collide(const Flight& flight, const glm::vec3& from, const glm::vec3& direction,
                      detail::PathRandom& random) const;
  // The first that a path meets: surface or something in a medium.
  detail::Hit meet(const glm::vec3& from, const glm::vec3& direction, detail::PathRandom& random,
                   float reach = std::numeric_limits<float>::infinity()) const {
    if (media.empty()) return closest(from, direction, detail::Coherence::incoherent, reach);
    const Flight flight = fly(from, direction, random);
    const detail::Hit hit = closest(from, direction, detail::Coherence::incoherent, std::min(reach, flight.distance));
    return hit.surface == detail::Surface::none && flight.distance < reach ? collide(flight, from, direction, random)
                                                                           : hit;
  }
  // Share of the light that all media let through along that way [1].
  float transmittance(const glm::vec3& from, const glm::vec3& direction) const;
  bool hasParticles() const {
    return std::any_of(media.begin(), media.end(), [](const detail::MediumField& field) { return !field.leaves(); });
  }

  // Start of a ray that leaves a surface on the side `normal` points to. A hit lies on its triangle's plane to within
  // about one rounding step of the largest coordinate, so a lift of eight steps puts it safely on the right side: no
  // ray meets again the flat leaf it leaves, be it one triangle or many. The lift is 1 um in a tree of 1 m and 12 um in
  // a stand of 25 m, a tenth of a leaf's thickness; as coordinates are taken about the stand's middle, it does not grow
  // with the distance from the world's origin. A ray that turns straight back (the hot spot) comes off its old way by
  // less than that.
  glm::vec3 leave(const glm::vec3& position, const glm::vec3& normal) const { return position + lift * normal; }

  glm::vec3 wrapped(glm::vec3 point) const;  // the same point in the traced period
  RTCScene countingScene() const;            // leaves alone, watertight, with filters; made when first asked for
  bool masked() const {
    return std::any_of(prototypes.begin(), prototypes.end(), [](const auto& of) { return of.cut(); });
  }
  // Where a leaf that was hit shows its images; none where that is not known.
  std::optional<glm::vec2> inImages(const detail::Hit& hit) const;
  // What a kind of tree is made of, about its pivot.
  std::vector<detail::Facet> facets(std::uint32_t kind) const;

  std::string embree_error;  // the first that Embree reported
  detail::Device device;
  detail::Scenes scenes;
  mutable detail::Scenes counting;
  mutable std::once_flag counting_made;

  glm::vec3 origin{0.f};                      // of all other coordinates here, in the stand's [m]
  std::vector<detail::Copy> copies;           // by Embree's instance number
  std::vector<detail::Prototype> prototypes;  // of each kind
  std::vector<double>
      leaf_area;  // of each leaf of all kinds, summed over the trees without their periodic copies [m^2]
  std::vector<detail::MediumField> media;
  std::string media_hash;           // of all that is in them
  bool surfaces = true;             // whether there are any at all
  std::optional<glm::vec2> period;  // [m]
  Bounds stand_box;                 // what RayScene::box tells, in the stand's coordinates
  Bounds box;                       // the same about `origin`
  float lift = 0.f;                 // [m]
  float low = 0.f, high = 0.f;      // z of a layer that holds everything with room for lifted points [m]

 private:
  mutable std::unique_ptr<const detail::RayTrees> trees_;  // made when first asked for
  mutable std::once_flag trees_made_;
  mutable std::atomic<const detail::RayTrees*> walked_ = nullptr;
  bool walks_ = false;

  void checkEmbree() const;  // throws std::runtime_error if Embree has reported an error
  detail::Scenes commit(std::vector<detail::EmbreeScene> made, RTCSceneFlags flags) const;
  detail::Hit describe(const detail::Met& met, const glm::vec3& from, const glm::vec3& direction) const;
  detail::Hit closestInPeriods(glm::vec3 point, const glm::vec3& direction, detail::Coherence coherence,
                               float reach) const;
  bool blockedInPeriods(glm::vec3 point, const glm::vec3& direction) const;
  // The first that a ray meets before `reach`, or whether there is any.
  std::optional<detail::Met> first(const glm::vec3& from, const glm::vec3& direction, detail::Coherence coherence,
                                   float reach) const;
  bool any(const glm::vec3& from, const glm::vec3& direction, float reach) const;
  detail::Met metBy(const RTCHit& hit, float distance) const;
  bool walksAlone() const { return walks_ && scenes.instances; }  // among copies packets of rays gain nothing
  const detail::RayTrees* walked() const;                         // none where Embree is asked
  bool enterLayer(glm::vec3& point, const glm::vec3& direction, float& reach) const;
};

}  // namespace sunfleck
