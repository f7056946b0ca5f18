#pragma once

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
  float pixels = 128.f;             // of an element of mean area that faces the sun, in the mean [1]
  double most_pixels = 4'194'304.;  // of a picture
};

// (F3) A stand as a sun sees it, row by row: along the middle of each row, which side is the first from where to where,
// to 1/64 of a pixel; and of each pixel, the first side behind its middle.
class SunPicture {
 public:
  static constexpr std::uint32_t kNoSide = ~0u;

  //   along   in which the light travels; with a period not level
  //   period  side lengths of the repeated rectangle [m]; none: the stand is alone
  SunPicture(const TreeMesh& mesh, const FieldElements& elements, const std::optional<glm::vec2>& period,
             Direction along, const DirectEffort& effort = {});

  Direction along() const { return along_; }
  // The area that each side shows, across the light: 2 element for the front of one, 2 element + 1 for its back [m^2].
  const std::vector<double>& shown() const { return shown_; }
  // What shows no side; without a period it depends on the picture's rim [m^2].
  double free() const { return free_; }
  // The side of an element that the sun lights at a place on it; kNoSide where another element is before it.
  std::uint32_t litSide(std::uint32_t element, const glm::vec3& place) const {
    float depth;
    const glm::ivec2 fine = grid_.pixelAt(place, depth);
    const detail::Crossing64 nearest =
        fine.x < 0
            ? kNothing
            : nearest_[static_cast<std::size_t>(fine.y) * columns_ + static_cast<std::uint32_t>(fine.x) / kFiner];
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
  static constexpr std::uint32_t kFiner = 64;  // parts of a pixel along its row

  const FieldElements* elements_;
  Direction along_;
  detail::LineGrid grid_;                    // of parts of pixels
  std::size_t columns_;                      // of pixels
  std::vector<detail::Crossing64> nearest_;  // of each pixel
  std::vector<double> shown_;
  double free_ = 0.;
};

}  // namespace sunfleck
