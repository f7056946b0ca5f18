#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "core/bounds.hpp"
#include "render/reference/detail/leaf_normals.hpp"
#include "render/reference/detail/path_random.hpp"
#include "render/reference/trace_medium.hpp"

namespace sunfleck::detail {

// Where light meets a medium.
struct Collision {
  float distance = std::numeric_limits<float>::infinity();  // [m]
  std::uint32_t cell = 0;
};

// (R14) A medium as rays pass it, cell by cell: its optical depths are exact. In a periodic stand it repeats.
class MediumField {
 public:
  //   origin  of the coordinates of rays, in the stand's [m]
  MediumField(const TraceMedium& medium, const glm::vec3& origin, const std::optional<glm::vec2>& period);

  // How far light goes that is to meet something after this optical depth [1].
  Collision fly(const glm::vec3& from, const glm::vec3& direction, float depth) const;
  // Optical depth on the whole way [1].
  float depth(const glm::vec3& from, const glm::vec3& direction) const;

  bool leaves() const { return scatterer_ == TraceMedium::Scatterer::leaves; }
  float asymmetry() const { return asymmetry_; }
  // Normal of a leaf that light along `direction` meets in a cell, on the side that the light comes from.
  glm::vec3 normal(std::uint32_t cell, const glm::vec3& direction, PathRandom& random) const;

 private:
  struct Ray;
  template <typename Segment>
  void walk(const glm::vec3& from, const glm::vec3& direction, const Segment& segment) const;
  template <typename Segment>
  bool stretch(const Ray& ray, float start, float end, const Segment& segment) const;
  template <typename Visit>
  void extinctions(const glm::vec3& from, const glm::vec3& direction, const Visit& visit) const;
  float projection(const glm::vec3& direction) const;
  std::size_t blockNumber(const glm::ivec3& block) const;
  void keep(const MediumVoxels& voxels, const std::optional<glm::vec2>& period);

  TraceMedium::Scatterer scatterer_;
  float asymmetry_;
  std::optional<LeafRings> rings_;
  Bounds box_;                       // of all that is not empty, about the origin [m]
  std::optional<glm::vec2> period_;  // in which the medium repeats: none for one without end [m]

  float density_ = 0.f;  // of a homogeneous one [1/m]
  // Of voxels:
  float cell_size_ = 0.f;              // [m]
  glm::vec3 corner_{0.f};              // of the first block's first cell, about the origin [m]
  glm::ivec3 blocks_{0};               // in all, along each axis; none for a homogeneous medium
  std::vector<std::int32_t> kept_;     // of each block: which of those kept, or -1
  std::vector<float> densities_;       // of the cells of those [1/m], or ...
  std::vector<LeafEllipsoid> turned_;  // ... of leaves that are turned in their own way [1/m]
};

}  // namespace sunfleck::detail
