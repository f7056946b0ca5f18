#include <cmath>

#include "render/reference/detail/scene_geometry.hpp"

namespace sunfleck {
using namespace detail;

// Media that fill the same space do not know of each other: the nearest of their collisions is the first of all.
RayScene::Geometry::Flight RayScene::Geometry::fly(const glm::vec3& from, const glm::vec3& direction,
                                                   PathRandom& random) const {
  Flight first;
  for (std::size_t i = 0; i < media.size(); ++i) {
    const float free = -std::log((static_cast<float>(random.bits()) + 0.5f) * 0x1p-32f);
    const Collision collision = media[i].fly(from, direction, free);
    if (collision.distance < first.distance) first = {collision, static_cast<std::uint32_t>(i)};
  }
  return first;
}

Hit RayScene::Geometry::collide(const Flight& flight, const glm::vec3& from, const glm::vec3& direction,
                                PathRandom& random) const {
  const MediumField& field = media[flight.medium];
  const glm::vec3 position = from + flight.distance * direction;
  return {.surface = field.leaves() ? Surface::turbid_leaf : Surface::particle,
          .kind = flight.medium,
          .position = period ? wrapped(position) : position,
          .normal = field.leaves() ? field.normal(flight.cell, direction, random) : -direction};
}

float RayScene::Geometry::transmittance(const glm::vec3& from, const glm::vec3& direction) const {
  float depth = 0.f;
  for (const MediumField& field : media) depth += field.depth(from, direction);
  return std::exp(-depth);
}

}  // namespace sunfleck
