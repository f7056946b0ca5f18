#pragma once

#include <atomic>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "core/directions.hpp"
#include "core/tree_mesh.hpp"
#include "field/detail/line_grid.hpp"
#include "field/elements.hpp"

namespace sunfleck {

// How finely a sun's light is sampled.
struct DirectEffort {
  float pixels = 256.f;             // of an element of mean area that faces the sun, in the mean [1]
  double most_pixels = 4'194'304.;  // of a picture
};

// (F3) A stand as a sun sees it: of each pixel, the first side behind its middle.
class SunPicture {
 public:
  static constexpr std::uint32_t kNoSide = ~0u;

  //   along   in which the light travels; with a period not level
  //   period  side lengths of the repeated rectangle [m]; none: the stand is alone
  SunPicture(const TreeMesh& mesh, const FieldElements& elements, const std::optional<glm::vec2>& period,
             Direction along, const DirectEffort& effort = {});

  Direction along() const { return along_; }
  std::size_t pixels() const { return nearest_.size(); }
  double pixelArea() const { return grid_.lineArea(); }  // across the light [m^2]
  // 2 element for the front of one, 2 element + 1 for its back, or kNoSide where light passes.
  std::uint32_t side(std::size_t pixel) const;
  // The side of an element that the sun lights at a place on it; kNoSide where another element is before it.
  std::uint32_t litSide(std::uint32_t element, const glm::vec3& place) const {
    float depth;
    const std::size_t pixel = grid_.lineAt(place, depth);
    const detail::Crossing64 nearest = pixel < pixels() ? nearest_[pixel].load(std::memory_order_relaxed) : kNothing;
    if (nearest != kNothing) {
      const std::uint32_t met = detail::sideMet(nearest);
      if (met / 2 == element) return met;
      const std::uint32_t leaf = elements_->leaf[element];
      const bool same_leaf = leaf != FieldElements::kWood && leaf == elements_->leaf[met / 2];
      if (!same_leaf && depth > detail::depthOf(nearest)) return kNoSide;
    }
    // The pixel's middle misses the element, or lies on one behind it.
    return 2 * element + (glm::dot(elements_->normal[element], along_) > 0.f);
  }

 private:
  static constexpr detail::Crossing64 kNothing = ~detail::Crossing64{0};

  const FieldElements* elements_;
  Direction along_;
  detail::LineGrid grid_;
  std::vector<std::atomic<detail::Crossing64>> nearest_;  // of each pixel
};

}  // namespace sunfleck
