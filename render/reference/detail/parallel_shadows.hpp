#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/directions.hpp"
#include "render/reference/detail/scene_geometry.hpp"

namespace sunfleck::detail {

// (R24) Whether anything stands between points and what is far away in one direction, the sun or the eye: a grid across
// that direction, whose cells list the facets that a line through them may meet. So most questions take the tests of 16
// facets side by side, a quarter of Embree's time. Embree is asked where there are too many facets, where they lie so
// that lists get long, where masks cut leaves and in periodic stands.
class ParallelShadows {
 public:
  //   scene  must outlive it
  //   to     unit vector to what is far away
  ParallelShadows(const RayScene::Geometry& scene, const glm::vec3& to);

  // As Geometry's, along `to`, but for lines that pass an edge within rounding.
  bool blocked(const glm::vec3& from) const;
  void blocked(std::span<const glm::vec3> from, std::span<bool> blocked) const;

  const glm::vec3& to() const { return to_; }
  bool asksEmbree() const { return blocks_.empty(); }

 private:
  // With x, y and z along the axes from the cell's middle, the grid's plane: a line meets the facet where 0 <= u, v and
  // u + v - min(u, v) [if a parallelogram] <= 1; the point is before it where its side is below 0.
  struct alignas(64) Block {
    static constexpr std::size_t kSize = 16;
    using Lanes = std::array<float, kSize>;
    Lanes u, u_x, u_y, v, v_x, v_y, side, side_x, side_y, side_z, parallelogram;
  };

  void fill(const std::vector<Facet>& facets, std::vector<std::vector<std::uint32_t>>& lists);
  void set(Block& block, std::size_t lane, const Facet& facet, const glm::dvec3& middle) const;

  const RayScene::Geometry& scene_;
  glm::vec3 to_;
  glm::dvec3 right_, up_, along_;  // axes
  double low_x_ = 0., low_y_ = 0., cell_ = 1., per_cell_ = 1.;
  std::uint32_t across_ = 0, down_ = 0;  // cells
  std::vector<std::uint32_t> first_;     // block of each cell, and the end
  std::vector<Block> blocks_;
};

}  // namespace sunfleck::detail
