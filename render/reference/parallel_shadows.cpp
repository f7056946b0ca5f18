#include "render/reference/detail/parallel_shadows.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace sunfleck::detail {
namespace {

constexpr std::size_t kMostFacets = 200'000;  // 30 MB
constexpr std::size_t kFacetsPerCell = 4;     // so many cells there are; as facets reach into several, lists are longer
constexpr double kMostBlocksRead = 4.;        // on the mean, where Embree would take as long

// A facet seen along the direction.
struct Outline {
  std::array<glm::dvec2, 4> corners;
  std::size_t count;

  explicit Outline(const Facet& facet, const glm::dvec3& right, const glm::dvec3& up)
      : count(facet.parallelogram ? 4 : 3) {
    const auto seen = [&](const glm::dvec3& point) { return glm::dvec2(glm::dot(point, right), glm::dot(point, up)); };
    corners = {seen(facet.corner), seen(facet.corner + facet.first), seen(facet.corner + facet.first + facet.second),
               seen(facet.corner + facet.second)};
    if (count == 3) corners[2] = corners[3];
  }

  glm::dvec2 low() const { return glm::min(glm::min(corners[0], corners[1]), glm::min(corners[2], corners[3])); }
  glm::dvec2 high() const { return glm::max(glm::max(corners[0], corners[1]), glm::max(corners[2], corners[3])); }

  // Whether a square may reach into it: unless a line along one of its edges parts them.
  bool reaches(const glm::dvec2& middle, double half) const {
    for (std::size_t i = 0; i < count; ++i) {
      const glm::dvec2 edge = corners[(i + 1) % count] - corners[i];
      const auto beside = [&](const glm::dvec2& point) { return edge.x * point.y - edge.y * point.x; };
      double low = beside(corners[0] - middle), high = low;
      for (std::size_t k = 1; k < count; ++k) {
        const double at = beside(corners[k] - middle);
        low = std::min(low, at);
        high = std::max(high, at);
      }
      const double reach = half * (std::abs(edge.x) + std::abs(edge.y));
      if (low > reach || high < -reach) return false;
    }
    return true;
  }
};

}  // namespace

ParallelShadows::ParallelShadows(const RayScene::Geometry& scene, const glm::vec3& to) : scene_(scene), to_(to) {
  const Axes axes = axesAlong(to);
  along_ = glm::normalize(glm::dvec3(axes.along));
  right_ = glm::normalize(glm::dvec3(axes.right) - glm::dot(glm::dvec3(axes.right), along_) * along_);
  up_ = glm::cross(along_, right_);
  if (scene.period) return;
  const std::optional<std::vector<Facet>> facets = scene.facets(kMostFacets);
  if (!facets || facets->empty()) return;

  std::vector<Outline> outlines;
  glm::dvec2 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const Facet& facet : *facets) {
    const Outline& outline = outlines.emplace_back(facet, right_, up_);
    low = glm::min(low, outline.low());
    high = glm::max(high, outline.high());
  }
  const glm::dvec2 size = high - low;
  const double cells = std::ceil(static_cast<double>(facets->size()) / kFacetsPerCell);
  cell_ = std::max({std::sqrt(size.x * size.y / cells), size.x / cells, size.y / cells, double{scene.lift}});
  per_cell_ = 1. / cell_;
  // Half a cell around, so that rounding leads no point of the edge outside.
  low_x_ = low.x - 0.5 * cell_;
  low_y_ = low.y - 0.5 * cell_;
  across_ = static_cast<std::uint32_t>(size.x * per_cell_) + 2;
  down_ = static_cast<std::uint32_t>(size.y * per_cell_) + 2;

  std::vector<std::vector<std::uint32_t>> lists(std::size_t{across_} * down_);
  const double margin = 1e-3 * cell_;  // far more than rounding
  const auto cellOf = [&](double place, double from, std::uint32_t count) {
    return static_cast<std::uint32_t>(std::clamp((place - from) * per_cell_, 0., count - 1.));
  };
  for (std::uint32_t i = 0; i < outlines.size(); ++i) {
    const glm::dvec2 first = outlines[i].low() - margin, last = outlines[i].high() + margin;
    for (std::uint32_t y = cellOf(first.y, low_y_, down_); y <= cellOf(last.y, low_y_, down_); ++y)
      for (std::uint32_t x = cellOf(first.x, low_x_, across_); x <= cellOf(last.x, low_x_, across_); ++x)
        if (outlines[i].reaches({low_x_ + (x + 0.5) * cell_, low_y_ + (y + 0.5) * cell_}, 0.5 * cell_ + margin))
          lists[std::size_t{y} * across_ + x].push_back(i);
  }
  double listed = 0., read = 0.;  // blocks, by a point on any facet
  for (const auto& list : lists) {
    const auto count = static_cast<double>(list.size());
    listed += count;
    read += count * std::ceil(count / Block::kSize);
  }
  if (read <= kMostBlocksRead * listed) fill(*facets, lists);
}

void ParallelShadows::fill(const std::vector<Facet>& facets, std::vector<std::vector<std::uint32_t>>& lists) {
  std::vector<double> depth;  // of the middles: what lies far along the direction shades most points, and is read first
  for (const Facet& facet : facets)
    depth.push_back(glm::dot(facet.corner + 0.5 * (facet.first + facet.second), along_));
  for (std::size_t cell = 0; cell < lists.size(); ++cell) {
    std::vector<std::uint32_t>& list = lists[cell];
    std::ranges::sort(
        list, [&](std::uint32_t a, std::uint32_t b) { return depth[a] != depth[b] ? depth[a] > depth[b] : a < b; });
    first_.push_back(static_cast<std::uint32_t>(blocks_.size()));
    const glm::dvec3 middle = (low_x_ + (static_cast<double>(cell % across_) + 0.5) * cell_) * right_ +
                              (low_y_ + (static_cast<double>(cell / across_) + 0.5) * cell_) * up_;
    for (std::size_t i = 0; i < list.size(); ++i) {
      const std::size_t lane = i % Block::kSize;
      if (lane == 0) blocks_.emplace_back().u.fill(-1.f);  // a lane of no facet
      set(blocks_.back(), lane, facets[list[i]], middle);
    }
  }
  first_.push_back(static_cast<std::uint32_t>(blocks_.size()));
}

void ParallelShadows::set(Block& block, std::size_t lane, const Facet& facet, const glm::dvec3& middle) const {
  const glm::dvec3 across = glm::cross(facet.first, facet.second);
  const double seen = glm::dot(across, along_);  // its area as it is seen, twice that of a triangle
  const double area = glm::length(across);
  // One that is seen from its edge alone is met by no line but those within rounding.
  if (!(std::abs(seen) > 1e-7 * area)) return;
  const glm::dvec3 u = glm::cross(facet.second, along_) / seen, v = glm::cross(along_, facet.first) / seen;
  const glm::dvec3 normal = across / std::copysign(area, seen);
  const glm::dvec3 from = middle - facet.corner;
  const auto put = [&](Block::Lanes& lanes, double value) { lanes[lane] = static_cast<float>(value); };
  put(block.u, glm::dot(u, from));
  put(block.u_x, glm::dot(u, right_));
  put(block.u_y, glm::dot(u, up_));
  put(block.v, glm::dot(v, from));
  put(block.v_x, glm::dot(v, right_));
  put(block.v_y, glm::dot(v, up_));
  put(block.side, glm::dot(normal, from));
  put(block.side_x, glm::dot(normal, right_));
  put(block.side_y, glm::dot(normal, up_));
  put(block.side_z, glm::dot(normal, along_));
  put(block.parallelogram, facet.parallelogram ? 1. : 0.);
}

bool ParallelShadows::blocked(const glm::vec3& from) const {
  if (blocks_.empty()) return scene_.blocked(from, to_);
  const glm::dvec3 point(from);
  const double right = (glm::dot(point, right_) - low_x_) * per_cell_, up = (glm::dot(point, up_) - low_y_) * per_cell_;
  if (!(right >= 0. && up >= 0. && right < across_ && up < down_)) return false;
  const auto column = static_cast<std::uint32_t>(right), row = static_cast<std::uint32_t>(up);
  const auto x = static_cast<float>((right - column - 0.5) * cell_), y = static_cast<float>((up - row - 0.5) * cell_),
             z = static_cast<float>(glm::dot(point, along_));
  const std::uint32_t* cell = &first_[std::size_t{row} * across_ + column];
  for (std::uint32_t i = cell[0]; i < cell[1]; ++i) {
    const Block& of = blocks_[i];
    int any = 0;
    for (std::size_t k = 0; k < Block::kSize; ++k) {
      const float u = of.u[k] + x * of.u_x[k] + y * of.u_y[k], v = of.v[k] + x * of.v_x[k] + y * of.v_y[k];
      const float side = of.side[k] + x * of.side_x[k] + y * of.side_y[k] + z * of.side_z[k];
      const float least = std::min(u, v);
      any |= static_cast<int>(least >= 0.f) & static_cast<int>(u + v - of.parallelogram[k] * least <= 1.f) &
             static_cast<int>(side < 0.f);
    }
    if (any != 0) return true;
  }
  return false;
}

void ParallelShadows::blocked(std::span<const glm::vec3> from, std::span<bool> is_blocked) const {
  if (blocks_.empty()) return scene_.blocked(from, to_, is_blocked);
  for (std::size_t i = 0; i < from.size(); ++i) is_blocked[i] = is_blocked[i] || blocked(from[i]);
}

}  // namespace sunfleck::detail
