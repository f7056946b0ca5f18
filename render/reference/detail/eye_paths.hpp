#pragma once

#include <cmath>
#include <limits>
#include <numbers>

#include "render/reference/detail/cosine_law.hpp"
#include "render/reference/detail/scattering.hpp"
#include "render/reference/detail/scene_geometry.hpp"
#include "render/reference/detail/scene_optics.hpp"

namespace sunfleck::detail {

// Radiance along a line of sight, for sun irradiance 1 on a plane that faces the sun [1/sr], by the surface that was
// seen and by how often its light has been scattered.
template <int N>
struct Seen {
  BandLanes<N> leaf_once, wood_once, ground_once, more;

  BandLanes<N>& once(Surface surface) {
    if (surface == Surface::none) return ground_once;
    return surface == Surface::leaf ? leaf_once : wood_once;
  }
};

// (R2) Paths from the eye, with the sun sampled wherever they meet something, before a black sky.
template <int N>
class EyePaths {
 public:
  //   ground  height of the ground about the scene's origin [m]; none if it is black in all bands
  EyePaths(const RayScene::Geometry& scene, const SceneOptics<N>& optics, Direction sun, float ground)
      : scene_(scene),
        optics_(optics),
        to_sun_(-sun),
        ground_(optics.ground().reflectance.largest() > 0.f ? ground : -kInfinity),
        reach_(0.5f * glm::length(scene.box.size()) + 8.f * scene.lift) {}

  // What is seen from a point on along `direction`.
  Seen<N> look(glm::vec3 from, glm::vec3 direction, PathRandom& random) const {
    Seen<N> seen;
    BandLanes<N> weight = BandLanes<N>::all(1.f);
    for (int scatterings = 0; scatterings < kMostScatterings; ++scatterings) {
      const float to_ground = toGround(from, direction);
      Hit hit =
          scene_.closest(from, direction, scatterings == 0 ? Coherence::coherent : Coherence::incoherent, to_ground);
      if (hit.surface == Surface::none) {
        if (to_ground == kInfinity) break;
        hit.position = from + to_ground * direction;
        hit.position.z = ground_;
        hit.normal = {0.f, 0.f, 1.f};
      }
      const SurfaceOptics<N>& surface = optics_.of(hit);
      addSun(hit, surface, weight, scatterings > 0 ? seen.more : seen.once(hit.surface));
      const Fate fate = scatter(surface, weight, random);
      if (fate == Fate::absorbed) break;
      const glm::vec3 side = fate == Fate::passed ? -hit.normal : hit.normal;
      from = scene_.leave(hit.position, side);
      direction = lambertDirection(side, random);
    }
    return seen;
  }

  // Where a line of sight through a point starts: right before the box, where positions are exact, but before it meets
  // the ground and, where a layer of trees has no end, before that.
  glm::vec3 startOf(const glm::vec3& on_line, const Direction& sight) const {
    const glm::vec3 from = on_line - (glm::dot(on_line - scene_.box.centre(), sight) + reach_) * sight;
    if (sight.z == 0.f || (!scene_.period && ground_ == -kInfinity)) return from;
    const float face = sight.z > 0.f ? scene_.low : std::max(scene_.high, ground_);
    return from + std::min(0.f, (face - from.z) / sight.z) * sight;
  }

 private:
  static constexpr float kInfinity = std::numeric_limits<float>::infinity();

  // Distance to the ground along a ray, infinite if it meets none.
  float toGround(const glm::vec3& from, const glm::vec3& direction) const {
    if (ground_ == -kInfinity || direction.z >= 0.f || from.z < ground_) return kInfinity;
    return (ground_ - from.z) / direction.z;
  }

  // Adds what a surface sends on from the sun to the side its normal points to.
  void addSun(const Hit& hit, const SurfaceOptics<N>& surface, const BandLanes<N>& weight, BandLanes<N>& seen) const {
    const float cosine = glm::dot(hit.normal, to_sun_);
    const BandLanes<N>& share = cosine > 0.f ? surface.reflectance : surface.transmittance;
    if (share.largest() == 0.f || cosine == 0.f) return;
    const glm::vec3 from = scene_.leave(hit.position, cosine > 0.f ? hit.normal : -hit.normal);
    if (scene_.blocked(from, to_sun_)) return;
    const float towards = std::abs(cosine) * std::numbers::inv_pi_v<float>;
    for (int band = 0; band < N; ++band) seen[band] += towards * weight[band] * share[band];
  }

  const RayScene::Geometry& scene_;
  const SceneOptics<N>& optics_;
  Direction to_sun_;
  float ground_;  // height, -infinity if there is none [m]
  float reach_;   // from the box's centre to where rays start [m]
};

}  // namespace sunfleck::detail
