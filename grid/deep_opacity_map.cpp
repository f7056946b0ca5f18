#include "grid/deep_opacity_map.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>

namespace sunfleck {
namespace {

struct Pixels {
  glm::dvec2 corner;
  double size;
  glm::ivec2 count;
};

// Twice the signed area of (a, b, p), computed alike for (a, b) and (b, a) so that two triangles on either side of an
// edge see exactly opposite values and never both claim, or both miss, a pixel on it.
double edgeSide(glm::dvec2 a, glm::dvec2 b, glm::dvec2 p) {
  const bool swap = a.x > b.x || (a.x == b.x && a.y > b.y);
  if (swap) std::swap(a, b);
  const double side = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
  return swap ? -side : side;
}

// A pixel centre exactly on an edge belongs to the triangle that lies to its left or below: the usual fill rule.
bool ownsEdge(glm::dvec2 a, glm::dvec2 b) {
  return a.y == b.y ? b.x < a.x : b.y < a.y;
}

// Calls visit(x, y, depth) for each pixel whose centre lies in the triangle, given as (right, up, depth) corners.
template <typename Visit>
void rasterize(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, const Pixels& pixels, const Visit& visit) {
  double twice_area = edgeSide(a, b, c);
  if (twice_area < 0.) {
    std::swap(b, c);
    twice_area = -twice_area;
  }
  if (!(twice_area > 0.)) return;  // edge-on: its line is met by no pixel centre
  const auto column = [&](double x) { return (x - pixels.corner.x) / pixels.size; };
  const auto row = [&](double y) { return (y - pixels.corner.y) / pixels.size; };
  const int x_first = std::max(0, static_cast<int>(std::floor(column(std::min({a.x, b.x, c.x})) - 0.5)));
  const int x_last = std::min(pixels.count.x - 1, static_cast<int>(std::ceil(column(std::max({a.x, b.x, c.x})) - 0.5)));
  const int y_first = std::max(0, static_cast<int>(std::floor(row(std::min({a.y, b.y, c.y})) - 0.5)));
  const int y_last = std::min(pixels.count.y - 1, static_cast<int>(std::ceil(row(std::max({a.y, b.y, c.y})) - 0.5)));
  const bool own_ab = ownsEdge(a, b), own_bc = ownsEdge(b, c), own_ca = ownsEdge(c, a);
  const auto inside = [](double side, bool own) { return side > 0. || (side == 0. && own); };
  for (int y = y_first; y <= y_last; ++y)
    for (int x = x_first; x <= x_last; ++x) {
      const glm::dvec2 p = pixels.corner + pixels.size * glm::dvec2(x + 0.5, y + 0.5);
      const double ab = edgeSide(a, b, p), bc = edgeSide(b, c, p), ca = edgeSide(c, a, p);
      if (inside(ab, own_ab) && inside(bc, own_bc) && inside(ca, own_ca))
        visit(x, y, (bc * a.z + ca * b.z + ab * c.z) / twice_area);
    }
}

struct Fragment {
  std::uint32_t pixel;
  Crossing crossing;
};

}  // namespace

DeepOpacityMap::DeepOpacityMap(const TreeMesh& mesh, Direction along, int resolution) : axes_(axesAlong(along)) {
  assert(resolution >= 1);
  std::vector<glm::vec3> projected;
  projected.reserve(mesh.vertices.size());
  for (const glm::vec3& vertex : mesh.vertices) projected.push_back(inMap(vertex));
  Bounds box;
  for (const auto* triangles : {&mesh.leaf_triangles, &mesh.wood_triangles})
    for (const glm::uvec3& t : *triangles)
      for (int corner = 0; corner < 3; ++corner) box.include(projected[t[corner]]);
  const glm::vec2 extent = box.size();
  pixel_size_ = std::max({extent.x, extent.y, 1e-6f}) / static_cast<float>(resolution);
  size_ = glm::clamp(glm::ivec2(glm::ceil(extent / pixel_size_)), 1, resolution);
  corner_ = glm::vec2(box.centre()) - 0.5f * pixel_size_ * glm::vec2(size_);

  const Pixels pixels{glm::dvec2(corner_), double{pixel_size_}, size_};
  const auto pixelNumber = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.x) + static_cast<std::size_t>(x);
  };
  const std::size_t pixel_count = pixelNumber(0, size_.y);

  std::vector<Fragment> fragments;
  first_.assign(pixel_count + 1, 0u);
  for (std::size_t i = 0; i < mesh.leaf_triangles.size(); ++i) {
    const glm::uvec3& t = mesh.leaf_triangles[i];
    rasterize(projected[t.x], projected[t.y], projected[t.z], pixels, [&](int x, int y, double depth) {
      const std::size_t pixel = pixelNumber(x, y);
      fragments.push_back({static_cast<std::uint32_t>(pixel), {static_cast<float>(depth), mesh.leaf_of_triangle[i]}});
      ++first_[pixel + 1];
    });
  }
  for (std::size_t pixel = 0; pixel < pixel_count; ++pixel) first_[pixel + 1] += first_[pixel];
  crossings_.resize(fragments.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (const Fragment& fragment : fragments) crossings_[next[fragment.pixel]++] = fragment.crossing;
  for (std::size_t pixel = 0; pixel < pixel_count; ++pixel)
    std::sort(
        crossings_.begin() + first_[pixel], crossings_.begin() + first_[pixel + 1],
        [](const Crossing& a, const Crossing& b) { return a.depth != b.depth ? a.depth < b.depth : a.leaf < b.leaf; });

  wood_depth_.assign(pixel_count, std::numeric_limits<float>::infinity());
  for (const glm::uvec3& t : mesh.wood_triangles)
    rasterize(projected[t.x], projected[t.y], projected[t.z], pixels, [&](int x, int y, double depth) {
      float& nearest = wood_depth_[pixelNumber(x, y)];
      nearest = std::min(nearest, static_cast<float>(depth));
    });
}

std::span<const Crossing> DeepOpacityMap::crossings(int x, int y) const {
  const std::size_t pixel =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.x) + static_cast<std::size_t>(x);
  return std::span(crossings_).subspan(first_[pixel], first_[pixel + 1] - first_[pixel]);
}

glm::vec3 DeepOpacityMap::inMap(glm::vec3 point) const {
  return {glm::dot(point, axes_.right), glm::dot(point, axes_.up), glm::dot(point, axes_.along)};
}

glm::vec3 DeepOpacityMap::inSpace(int x, int y, float depth) const {
  const glm::vec2 at = corner_ + pixel_size_ * (glm::vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5f);
  return at.x * axes_.right + at.y * axes_.up + depth * axes_.along;
}

DeepOpacityMap::Counts DeepOpacityMap::counts(glm::vec3 point, std::uint32_t own) const {
  const glm::vec3 at = inMap(point);
  const glm::vec2 pixel = (glm::vec2(at) - corner_) / pixel_size_;
  if (!(pixel.x >= 0.f && pixel.y >= 0.f && pixel.x < static_cast<float>(size_.x) &&
        pixel.y < static_cast<float>(size_.y)))
    return {};
  Counts counts;
  for (const Crossing& crossing : crossings(static_cast<int>(pixel.x), static_cast<int>(pixel.y)))
    if (crossing.leaf != own) ++(crossing.depth < at.z ? counts.before : counts.beyond);
  return counts;
}

std::vector<DeepOpacityMap> deepOpacityMaps(const TreeMesh& mesh, std::span<const Direction> directions,
                                            int resolution) {
  std::vector<std::optional<DeepOpacityMap>> made(directions.size());
  tbb::parallel_for(std::size_t{0}, directions.size(),
                    [&](std::size_t i) { made[i].emplace(mesh, directions[i], resolution); });
  std::vector<DeepOpacityMap> maps;
  maps.reserve(made.size());
  for (auto& map : made) maps.push_back(std::move(*map));
  return maps;
}

}  // namespace sunfleck
