#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/directions.hpp"
#include "render/reference/detail/facet_block.hpp"
#include "render/reference/detail/scene_geometry.hpp"

namespace sunfleck::detail {

// Whether anything stands between points and what is far away in one direction, the sun or the eye: a grid across
// that direction, whose cells list the facets that a line through them may meet. So most questions take the tests of 16
// facets side by side, a quarter of Embree's time. Embree is asked where there are too many facets, where they lie so
// that lists get long, where masks cut leaves and in periodic stands.
class ParallelShadows {
 public:
  //   scene  must outlive it
  //   to     unit vector to what is far away
  ParallelShadows(const RayScene::Geometry& scene, const glm::vec3& to);

  // A point that is asked for. What the answer takes is fetched from memory while the caller does something else.
  struct Point {
    glm::vec3 from{0.f};
    const FacetBlock *first = nullptr, *last = nullptr;
    float x = 0.f, y = 0.f, z = 0.f;
  };
  Point fetch(const glm::vec3& from) const;
  // As Geometry's, along `to`, but for lines that pass an edge within rounding.
  bool blocked(const Point& point) const {
    if (blocks_.empty()) return scene_.blocked(point.from, to_);
    return before_facet_(point.first, point.last, point.x, point.y, point.z);
  }
  bool blocked(const glm::vec3& from) const { return blocked(fetch(from)); }
  void blocked(std::span<const glm::vec3> from, std::span<bool> blocked) const;

  // Whether no line through the parallelogram at `corner` meets anything, as far as the grid can tell.
  bool nothingThrough(const glm::vec3& corner, const glm::vec3& first, const glm::vec3& second) const;

  const glm::vec3& to() const { return to_; }
  bool asksEmbree() const { return blocks_.empty(); }

 private:
  void fill(const std::vector<Facet>& facets, std::vector<std::vector<std::uint32_t>>& lists);
  void set(FacetBlock& block, std::size_t lane, const Facet& facet, const glm::dvec3& middle) const;

  const RayScene::Geometry& scene_;
  glm::vec3 to_;
  glm::dvec3 right_, up_, along_;  // axes
  double low_x_ = 0., low_y_ = 0., cell_ = 1., per_cell_ = 1.;
  std::uint32_t across_ = 0, down_ = 0;  // cells
  std::vector<std::uint32_t> first_;     // block of each cell, and the end
  std::vector<FacetBlock> blocks_;
  BeforeFacet* before_facet_;
};

}  // namespace sunfleck::detail
