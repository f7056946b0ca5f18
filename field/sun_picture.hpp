#pragma once

#include <atomic>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
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
  // The sides of elements that the sun lights at places on them; kNoSide where another element is before one.
  void litSides(std::span<const std::uint32_t> elements, std::span<const glm::vec3> places,
                std::span<std::uint32_t> sides) const;

 private:
  std::uint32_t litSide(std::uint32_t element, float depth, detail::Crossing64 nearest) const;

  const FieldElements* elements_;
  Direction along_;
  detail::LineGrid grid_;
  std::vector<std::atomic<detail::Crossing64>> nearest_;  // of each pixel
};

}  // namespace sunfleck
