#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "render/reference/camera_trace.hpp"
#include "render/reference/detail/scattering.hpp"
#include "render/reference/detail/scene_geometry.hpp"
#include "render/reference/detail/scene_light.hpp"
#include "render/reference/detail/scene_optics.hpp"

namespace sunfleck::detail {

// Radiance along a line of sight, for sun irradiance 1 on a plane that faces the sun [1/sr], by the surface that was
// seen and by how often its light has been scattered.
template <int N>
struct Seen {
  BandLanes<N> leaf_once, wood_once, ground_once, more;  // what media hold counts as leaves
  BandLanes<N> light;                                    // the sky or the sun's disc itself, never scattered

  BandLanes<N>& once(Surface surface) {
    if (surface == Surface::none) return ground_once;
    return surface == Surface::wood ? wood_once : leaf_once;
  }
};

// (R2) Paths from the eye, with the sun and the sky sampled wherever they meet something (R18).
template <int N>
class EyePaths {
 public:
  //   ground  height of the ground about the scene's origin [m]; none if it is black in all bands
  EyePaths(const RayScene::Geometry& scene, const SceneOptics<N>& optics, const SceneLight& light, float ground,
           Followed followed = Followed::all)
      : scene_(scene),
        optics_(optics),
        light_(light),
        point_sun_(light.pointSun()),
        wide_(light.wide()),
        followed_(followed),
        to_sun_(light.toSun()),
        sun_(light.sunIrradiance<N>()),
        ground_(optics.ground().reflectance.largest() > 0.f ? ground : -kInfinity),
        reach_(0.5f * glm::length(scene.box.size()) + 8.f * scene.lift) {}

  // What is seen along lines of sight from these points, at most RayScene::Geometry::kPacket.
  void look(std::span<const glm::vec3> from, std::span<const Direction> sights, std::span<PathRandom> random,
            std::span<Seen<N>> seen) const {
    constexpr std::size_t kPacket = RayScene::Geometry::kPacket;
    const std::size_t count = from.size();
    std::array<float, kPacket> to_ground;
    std::array<Hit, kPacket> hits;
    std::array<glm::vec3, kPacket> lit{};  // where light from the sun would come in
    std::array<bool, kPacket> dark;
    for (std::size_t i = 0; i < count; ++i) to_ground[i] = toGround(from[i], sights[i]);
    if (scene_.media.empty())
      scene_.closest(from, sights, std::span(to_ground).first(count), std::span(hits).first(count));
    else
      lookIntoMedia(from, sights, random, to_ground, hits);
    for (std::size_t i = 0; i < count; ++i) {
      seen[i] = {};
      dark[i] = !meets(hits[i], from[i], sights[i], to_ground[i]) || !sendsSun(hits[i], lit[i]);
    }
    scene_.blocked(std::span(lit).first(count), to_sun_, std::span(dark).first(count));
    for (std::size_t i = 0; i < count; ++i) {
      if (!meets(hits[i], from[i], sights[i], to_ground[i])) {
        if (wide_) seen[i].light = light_.met<N>(sights[i], kInfinity);
        continue;
      }
      const BandLanes<N> weight = BandLanes<N>::all(1.f);
      if (!dark[i]) addSun(hits[i], sights[i], lit[i], weight, seen[i].once(hits[i].surface));
      if (wide_) addDrawn(hits[i], sights[i], weight, random[i], seen[i].once(hits[i].surface));
      if (followed_ == Followed::all || wide_) goOn(hits[i], sights[i], weight, random[i], seen[i]);
    }
  }

  Seen<N> look(const glm::vec3& from, const Direction& sight, PathRandom& random) const {
    Seen<N> seen;
    look(std::span(&from, 1), std::span(&sight, 1), std::span(&random, 1), std::span(&seen, 1));
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

  // The same of a line of sight from an eye, which sees nothing behind itself.
  glm::vec3 startBefore(const glm::vec3& eye, const Direction& sight) const {
    const glm::vec3 from = startOf(eye, sight);
    return glm::dot(from - eye, sight) > 0.f ? from : eye;
  }

 private:
  static constexpr float kInfinity = std::numeric_limits<float>::infinity();

  // What is met first along lines of sight where there are media.
  void lookIntoMedia(std::span<const glm::vec3> from, std::span<const Direction> sights, std::span<PathRandom> random,
                     std::span<const float> to_ground, std::span<Hit> hits) const {
    std::array<RayScene::Geometry::Flight, RayScene::Geometry::kPacket> flights;
    std::array<float, RayScene::Geometry::kPacket> reach;
    for (std::size_t i = 0; i < from.size(); ++i) {
      flights[i] = scene_.fly(from[i], sights[i], random[i]);
      reach[i] = std::min(to_ground[i], flights[i].distance);
    }
    scene_.closest(from, sights, std::span(reach).first(from.size()), hits.first(from.size()));
    for (std::size_t i = 0; i < from.size(); ++i)
      if (hits[i].surface == Surface::none && flights[i].distance < to_ground[i])
        hits[i] = scene_.collide(flights[i], from[i], sights[i], random[i]);
  }

  // Distance to the ground along a ray, infinite if it meets none.
  float toGround(const glm::vec3& from, const glm::vec3& direction) const {
    if (ground_ == -kInfinity || direction.z >= 0.f || from.z < ground_) return kInfinity;
    return (ground_ - from.z) / direction.z;
  }

  // Whether a ray meets something; where nothing else is, that may be the ground, which `hit` then becomes.
  bool meets(Hit& hit, const glm::vec3& from, const glm::vec3& direction, float to_ground) const {
    if (hit.surface != Surface::none) return true;
    if (to_ground == kInfinity) return false;
    hit.position = from + to_ground * direction;
    hit.position.z = ground_;
    hit.normal = {0.f, 0.f, 1.f};
    return true;
  }

  // Follows a path on from where it met something, travelling along `direction`, and adds what it sees there.
  void goOn(Hit hit, glm::vec3 direction, BandLanes<N> weight, PathRandom& random, Seen<N>& seen) const {
    const Surface first = hit.surface;
    for (int scatterings = 1; scatterings < kMostScatterings; ++scatterings) {
      const BandLanes<N> arriving = weight;
      const Onward onward = optics_.scatter(hit, direction, weight, random);
      if (onward.fate == Fate::absorbed) return;
      const float density = wide_ ? optics_.density(hit, direction, arriving, onward.direction) : 0.f;
      const glm::vec3 from = scene_.leave(hit.position, onward.side);
      direction = onward.direction;
      const float to_ground = toGround(from, direction);
      hit = scene_.meet(from, direction, random, to_ground);
      if (!meets(hit, from, direction, to_ground)) {
        if (wide_) addMet(direction, density, weight, scatterings == 1 ? seen.once(first) : seen.more);
        return;
      }
      if (followed_ == Followed::once) return;
      glm::vec3 lit;
      if (sendsSun(hit, lit) && !scene_.blocked(lit, to_sun_)) addSun(hit, direction, lit, weight, seen.more);
      if (wide_) addDrawn(hit, direction, weight, random, seen.more);
    }
  }

  // Whether a surface sends anything on of the sun's light, and where the light would come in.
  bool sendsSun(const Hit& hit, glm::vec3& lit) const {
    const float cosine = glm::dot(hit.normal, to_sun_);
    const SurfaceOptics<N>& surface = optics_.of(hit);
    if (!point_sun_ || cosine == 0.f || (cosine > 0.f ? surface.reflectance : surface.transmittance).largest() == 0.f)
      return false;
    lit = scene_.leave(hit.position, cosine > 0.f ? hit.normal : -hit.normal);
    return true;
  }

  // `lit`: where the light comes in.
  void addSun(const Hit& hit, const glm::vec3& direction, const glm::vec3& lit, const BandLanes<N>& weight,
              BandLanes<N>& seen) const {
    BandLanes<N> sent = optics_.sent(hit, direction, to_sun_);
    if (!scene_.media.empty()) sent *= scene_.transmittance(lit, to_sun_);
    for (int band = 0; band < N; ++band) seen[band] += weight[band] * sent[band] * sun_[band];
  }

  // What a surface, met along `direction`, sends on of the light drawn from the sky and the sun's disc, by the share
  // that the balance heuristic leaves to it.
  void addDrawn(const Hit& hit, const glm::vec3& direction, const BandLanes<N>& weight, PathRandom& random,
                BandLanes<N>& seen) const {
    light_.draw<N>(random, [&](const DrawnLight<N>& drawn) {
      BandLanes<N> arriving = optics_.sent(hit, direction, drawn.to_light);
      arriving *= weight;
      arriving *= drawn.radiance;
      if (!(arriving.largest() > 0.f)) return;
      const glm::vec3 side = glm::dot(hit.normal, drawn.to_light) > 0.f ? hit.normal : -hit.normal;
      const glm::vec3 lit = scene_.leave(hit.position, side);
      if (scene_.blocked(lit, drawn.to_light)) return;
      if (!scene_.media.empty()) arriving *= scene_.transmittance(lit, drawn.to_light);
      arriving *= 1.f / (drawn.density + optics_.density(hit, direction, weight, drawn.to_light));
      for (int band = 0; band < N; ++band) seen[band] += arriving[band];
    });
  }

  void addMet(const glm::vec3& direction, float density, const BandLanes<N>& weight, BandLanes<N>& seen) const {
    const BandLanes<N> met = light_.met<N>(direction, density);
    for (int band = 0; band < N; ++band) seen[band] += weight[band] * met[band];
  }

  const RayScene::Geometry& scene_;
  const SceneOptics<N>& optics_;
  const SceneLight& light_;
  bool point_sun_, wide_;  // of the light
  Followed followed_;
  Direction to_sun_;
  BandLanes<N> sun_;  // irradiance of a plane that faces the sun [1]
  float ground_;      // height, -infinity if there is none [m]
  float reach_;       // from the box's centre to where rays start [m]
};

}  // namespace sunfleck::detail
