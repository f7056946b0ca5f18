#include "render/reference/detail/parallel_shadows.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "core/instruction_set.hpp"

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

// All that stands, copy after copy, about the scene's origin.
std::vector<Facet> placed(const RayScene::Geometry& scene) {
  std::vector<std::vector<Facet>> of_kinds;
  for (std::uint32_t kind = 0; kind < scene.prototypes.size(); ++kind) of_kinds.push_back(scene.facets(kind));
  std::vector<Facet> all;
  for (const Copy& copy : scene.copies) {
    const double c = double{copy.cosine}, s = double{copy.sine};
    const auto rotated = [&](const glm::dvec3& v) { return glm::dvec3(c * v.x - s * v.y, s * v.x + c * v.y, v.z); };
    for (Facet facet : of_kinds[copy.kind]) {
      facet.corner = rotated(facet.corner) + glm::dvec3(copy.translation);
      facet.first = rotated(facet.first);
      facet.second = rotated(facet.second);
      all.push_back(facet);
    }
  }
  return all;
}

}  // namespace

BeforeFacet* beforeFacet() {
#ifdef SUNFLECK_X86
  return &bestOf<BeforeFacet>({&baseline::beforeFacet, &avx2::beforeFacet, &avx512::beforeFacet});
#else
  return &bestOf<BeforeFacet>({&baseline::beforeFacet});
#endif
}

ParallelShadows::ParallelShadows(const RayScene::Geometry& scene, const glm::vec3& to)
    : scene_(scene), to_(to), before_facet_(beforeFacet()) {
  const Axes axes = axesAlong(to);
  along_ = glm::normalize(glm::dvec3(axes.along));
  right_ = glm::normalize(glm::dvec3(axes.right) - glm::dot(glm::dvec3(axes.right), along_) * along_);
  up_ = glm::cross(along_, right_);
  std::size_t primitives = 0;
  for (const Copy& copy : scene.copies) primitives += scene.prototypes[copy.kind].planes.size();
  if (scene.period || scene.masked() || primitives == 0 || primitives > kMostFacets) return;
  const std::vector<Facet> facets = placed(scene);

  std::vector<Outline> outlines;
  glm::dvec2 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const Facet& facet : facets) {
    const Outline& outline = outlines.emplace_back(facet, right_, up_);
    low = glm::min(low, outline.low());
    high = glm::max(high, outline.high());
  }
  const glm::dvec2 size = high - low;
  const double cells = std::ceil(static_cast<double>(facets.size()) / kFacetsPerCell);
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
    read += count * std::ceil(count / FacetBlock::kSize);
  }
  if (read <= kMostBlocksRead * listed) fill(facets, lists);
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
      const std::size_t lane = i % FacetBlock::kSize;
      if (lane == 0) blocks_.emplace_back().u.fill(-1.f);  // a lane of no facet
      set(blocks_.back(), lane, facets[list[i]], middle);
    }
  }
  first_.push_back(static_cast<std::uint32_t>(blocks_.size()));
}

void ParallelShadows::set(FacetBlock& block, std::size_t lane, const Facet& facet, const glm::dvec3& middle) const {
  const glm::dvec3 across = glm::cross(facet.first, facet.second);
  const double seen = glm::dot(across, along_);  // its area as it is seen, twice that of a triangle
  const double area = glm::length(across);
  // One that is seen from its edge alone is met by no line but those within rounding.
  if (!(std::abs(seen) > 1e-7 * area)) return;
  const glm::dvec3 u = glm::cross(facet.second, along_) / seen, v = glm::cross(along_, facet.first) / seen;
  const glm::dvec3 normal = across / std::copysign(area, seen);
  const glm::dvec3 from = middle - facet.corner;
  const auto put = [&](FacetBlock::Lanes& lanes, double value) { lanes[lane] = static_cast<float>(value); };
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

ParallelShadows::Point ParallelShadows::fetch(const glm::vec3& from) const {
  Point asked{.from = from};
  if (blocks_.empty()) return asked;
  const glm::dvec3 point(from);
  const double right = (glm::dot(point, right_) - low_x_) * per_cell_, up = (glm::dot(point, up_) - low_y_) * per_cell_;
  if (!(right >= 0. && up >= 0. && right < across_ && up < down_)) return asked;
  const auto column = static_cast<std::uint32_t>(right), row = static_cast<std::uint32_t>(up);
  const std::uint32_t* cell = &first_[std::size_t{row} * across_ + column];
  asked.first = blocks_.data() + cell[0];
  asked.last = blocks_.data() + cell[1];
  asked.x = static_cast<float>((right - column - 0.5) * cell_);
  asked.y = static_cast<float>((up - row - 0.5) * cell_);
  asked.z = static_cast<float>(glm::dot(point, along_));
  if (asked.first != asked.last)
    for (std::size_t line = 0; line < sizeof(FacetBlock); line += 64)
      __builtin_prefetch(reinterpret_cast<const char*>(asked.first) + line);
  return asked;
}

bool ParallelShadows::nothingThrough(const glm::vec3& corner, const glm::vec3& first, const glm::vec3& second) const {
  if (blocks_.empty()) return false;
  glm::dvec2 low(std::numeric_limits<double>::infinity()), high = -low;  // [cell]
  for (const glm::dvec3& point :
       {glm::dvec3(corner), glm::dvec3(corner) + glm::dvec3(first), glm::dvec3(corner) + glm::dvec3(second),
        glm::dvec3(corner) + glm::dvec3(first) + glm::dvec3(second)}) {
    const glm::dvec2 at((glm::dot(point, right_) - low_x_) * per_cell_, (glm::dot(point, up_) - low_y_) * per_cell_);
    low = glm::min(low, at);
    high = glm::max(high, at);
  }
  // Cells list what comes within a thousandth of a cell: rounding of the lines is much less.
  const auto first_of = [](double place, std::uint32_t count) {
    return static_cast<std::uint32_t>(std::clamp(std::floor(place), 0., static_cast<double>(count)));
  };
  const std::uint32_t left = first_of(low.x, across_), right = first_of(high.x + 1., across_);
  for (std::uint32_t row = first_of(low.y, down_); row < first_of(high.y + 1., down_); ++row)
    if (left < right && first_[std::size_t{row} * across_ + left] != first_[std::size_t{row} * across_ + right])
      return false;
  return true;
}

void ParallelShadows::blocked(std::span<const glm::vec3> from, std::span<bool> is_blocked) const {
  if (blocks_.empty()) return scene_.blocked(from, to_, is_blocked);
  for (std::size_t i = 0; i < from.size(); ++i) is_blocked[i] = is_blocked[i] || blocked(from[i]);
}

}  // namespace sunfleck::detail
