#include "render/reference/trace_cells.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/require.hpp"
#include "render/reference/detail/scene_geometry.hpp"

namespace sunfleck {

TraceCells::TraceCells(const RayScene& scene, double side, std::size_t bands)
    : low_(scene.geometry().box.low),
      high_(scene.geometry().box.high),
      origin_(scene.geometry().origin),
      periodic_(scene.geometry().period.has_value()),
      side_(side),
      per_length_(static_cast<float>(1. / side)) {
  require(std::isfinite(side) && side >= 1e-6, "side of the cells", side, "at least 1e-6 m");
  double cells = 1.;
  for (int axis = 0; axis < 3; ++axis) {
    const double along = std::max(1., std::ceil((double{high_[axis]} - double{low_[axis]}) / side - 1e-6));
    cells *= along;
    if (along < double{kMostSums}) counts_[axis] = static_cast<std::size_t>(along);
  }
  const std::size_t most = kMostSums / (2 * bands);
  require(cells <= static_cast<double>(most), "number of cells of " + std::to_string(side) + " m in the traced box",
          cells, "at most " + std::to_string(most) + " for so many bands: take larger ones");
}

std::size_t TraceCells::at(const glm::vec3& point) const {
  glm::vec<3, std::size_t> cell;
  for (int axis = 0; axis < 3; ++axis) {
    const float along = std::max(0.f, (point[axis] - low_[axis]) * per_length_);
    cell[axis] = std::min(static_cast<std::size_t>(along), counts_[axis] - 1);
  }
  return (cell.z * counts_.y + cell.y) * counts_.x + cell.x;
}

glm::uvec3 TraceCells::place(std::size_t cell) const {
  return glm::vec<3, std::size_t>(cell % counts_.x, cell / counts_.x % counts_.y, cell / (counts_.x * counts_.y));
}

glm::dvec3 TraceCells::corner() const {
  return glm::dvec3(low_) + glm::dvec3(origin_);
}

glm::dvec3 TraceCells::size(std::size_t cell) const {
  glm::dvec3 size(side_);
  for (int axis = 0; axis < 2 && periodic_; ++axis) {
    const double left = double{high_[axis]} - double{low_[axis]} - side_ * place(cell)[axis];
    size[axis] = std::min(side_, left);
  }
  return size;
}

}  // namespace sunfleck
