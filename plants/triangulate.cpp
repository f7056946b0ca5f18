#include "plants/detail/triangulate.hpp"

#include <glm/geometric.hpp>
#include <utility>

namespace sunfleck::detail {
namespace {

// Twice the signed area of a triangle seen along the polygon's normal.
double turnOf(const glm::dvec3& normal, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  return glm::dot(normal, glm::cross(b - a, c - a));
}

class EarCutter {
 public:
  EarCutter(const std::vector<glm::vec3>& vertices, std::span<const std::uint32_t> corners)
      : vertices_(vertices), left_(corners.begin(), corners.end()) {
    // Newell's normal, from the first corner so that far-off polygons lose no digits.
    for (std::size_t i = 1; i + 1 < left_.size(); ++i) normal_ += glm::cross(at(i) - at(0), at(i + 1) - at(0));
  }

  void cut(std::vector<glm::uvec3>& triangles) {
    while (left_.size() > 3) {
      const std::size_t ear = findEar();
      triangles.push_back({left_[before(ear)], left_[ear], left_[after(ear)]});
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    triangles.push_back({left_[0], left_[1], left_[2]});
  }

 private:
  glm::dvec3 at(std::size_t i) const { return vertices_[left_[i]]; }
  std::size_t before(std::size_t i) const { return i == 0 ? left_.size() - 1 : i - 1; }
  std::size_t after(std::size_t i) const { return i + 1 == left_.size() ? 0 : i + 1; }

  bool isEar(std::size_t i) const {
    const glm::dvec3 a = at(before(i)), b = at(i), c = at(after(i));
    if (turnOf(normal_, a, b, c) <= 0.) return false;
    for (std::size_t other = 0; other < left_.size(); ++other) {
      if (other == i || other == before(i) || other == after(i)) continue;
      const glm::dvec3 p = at(other);
      if (p == a || p == b || p == c) continue;
      if (turnOf(normal_, a, b, p) >= 0. && turnOf(normal_, b, c, p) >= 0. && turnOf(normal_, c, a, p) >= 0.)
        return false;
    }
    return true;
  }

  // An ear; in a polygon that crosses itself there may be none, and any corner serves.
  std::size_t findEar() const {
    for (std::size_t i = 1; i < left_.size(); ++i)
      if (isEar(i)) return i;
    return isEar(0) ? 0 : 1;
  }

  const std::vector<glm::vec3>& vertices_;
  std::vector<std::uint32_t> left_;
  glm::dvec3 normal_{0.};
};

}  // namespace

void triangulate(const std::vector<glm::vec3>& vertices, std::span<const std::uint32_t> corners,
                 std::vector<glm::uvec3>& triangles) {
  if (corners.size() == 3)
    triangles.push_back({corners[0], corners[1], corners[2]});
  else if (corners.size() > 3)
    EarCutter(vertices, corners).cut(triangles);
}

}  // namespace sunfleck::detail
