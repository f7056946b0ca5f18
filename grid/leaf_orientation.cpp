#include "grid/leaf_orientation.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace sunfleck {

float LeafOrientation::projection(const Direction& s) const {
  const glm::vec3 m(xx * s.x + xy * s.y + xz * s.z, xy * s.x + yy * s.y + yz * s.z, xz * s.x + yz * s.y + zz() * s.z);
  return std::sqrt(std::clamp((5.f * glm::dot(s, m) + 3.f * glm::dot(m, m)) / 8.f, 0.f, 1.f));
}

bool LeafOrientation::possible() const {
  constexpr float rounding = 2e-3f;  // of 16 bits, 2^-11 of each entry, some three times over
  const float determinant =
      xx * (yy * zz() - yz * yz) - xy * (xy * zz() - yz * xz) + xz * (xy * yz - yy * xz);  // not finite if an entry is
  return std::isfinite(determinant) && std::min({xx, yy, zz()}) >= -rounding && xx * yy - xy * xy >= -rounding &&
         xx * zz() - xz * xz >= -rounding && yy * zz() - yz * yz >= -rounding && determinant >= -rounding;
}

}  // namespace sunfleck
