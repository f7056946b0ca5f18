#include "render/reference/detail/medium_field.hpp"

#include <algorithm>
#include <cmath>

#include "core/require.hpp"
#include "render/reference/detail/scene_geometry.hpp"

namespace sunfleck::detail {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr double kMostBlocks = 1u << 26;  // of the box around all, kept or not

}  // namespace

struct MediumField::Ray {
  Ray(const glm::vec3& start, const glm::vec3& along) : from(start), direction(along), inverse(1.f / along) {}

  glm::vec3 from, direction, inverse;

  float toPlane(int axis, float place) const {
    return direction[axis] == 0.f ? kInfinity : (place - from[axis]) * inverse[axis];
  }

  // Cuts what lies outside of low .. high along an axis off start .. end; whether something is left.
  bool clip(int axis, float low, float high, float& start, float& end) const {
    if (direction[axis] == 0.f) return from[axis] >= low && from[axis] < high;
    const float a = (low - from[axis]) * inverse[axis], b = (high - from[axis]) * inverse[axis];
    start = std::max(start, std::min(a, b));
    end = std::min(end, std::max(a, b));
    return start < end;
  }

  // `visit(cell, start, end)` of each cell of a grid that the ray passes between start and end, until it answers true.
  template <typename Visit>
  bool throughCells(const glm::vec3& low, float side, const glm::ivec3& first, const glm::ivec3& last, float start,
                    float end, const Visit& visit) const {
    const glm::vec3 at = (from + start * direction - low) / side;
    glm::ivec3 cell = glm::clamp(glm::ivec3(glm::floor(at)), first, last);
    const glm::ivec3 ahead(direction.x > 0.f, direction.y > 0.f, direction.z > 0.f);
    glm::vec3 wall;
    const auto findWall = [&](int axis) {
      wall[axis] = toPlane(axis, low[axis] + static_cast<float>(cell[axis] + ahead[axis]) * side);
    };
    for (int axis = 0; axis < 3; ++axis) findWall(axis);
    while (true) {
      const int axis = wall.x < wall.y ? (wall.x < wall.z ? 0 : 2) : (wall.y < wall.z ? 1 : 2);
      const float leaving = std::min(wall[axis], end);
      if (leaving > start) {
        if (visit(cell, start, leaving)) return true;
        start = leaving;
      }
      if (wall[axis] >= end) return false;
      cell[axis] += 2 * ahead[axis] - 1;
      if (cell[axis] < first[axis] || cell[axis] > last[axis]) return false;
      findWall(axis);
    }
  }
};

MediumField::MediumField(const TraceMedium& medium, const glm::vec3& origin, const std::optional<glm::vec2>& period)
    : scatterer_(medium.scatterer), asymmetry_(medium.asymmetry), density_(medium.density) {
  if (!medium.rings.empty()) rings_.emplace(medium.rings);
  const Bounds box = occupied(medium);
  box_ = {.low = box.low - origin, .high = box.high - origin};
  if (period && std::isfinite(box_.low.x + box_.high.x + box_.low.y + box_.high.y)) {
    // A medium without end along one axis alone repeats along it as well: it fills the period.
    period_ = period;
  } else if (period && (std::isfinite(box_.low.x) || std::isfinite(box_.low.y))) {
    period_ = period;
    for (int axis = 0; axis < 2; ++axis)
      if (!std::isfinite(box_.low[axis])) {
        box_.low[axis] = 0.f;
        box_.high[axis] = (*period)[axis];
      }
  }
  if (medium.voxels) {
    corner_ = medium.voxels->corner - origin;
    keep(*medium.voxels, period);
  }
}

void MediumField::keep(const MediumVoxels& voxels, const std::optional<glm::vec2>& period) {
  cell_size_ = voxels.cell_size;
  glm::ivec3 low(INT32_MAX), high(INT32_MIN);
  for (const glm::ivec3& block : voxels.blocks) {
    low = glm::min(low, block);
    high = glm::max(high, block + 1);
  }
  const glm::dvec3 spanned = glm::dvec3(high) - glm::dvec3(low);
  require(spanned.x * spanned.y * spanned.z <= kMostBlocks, "blocks that a medium's cells span",
          spanned.x * spanned.y * spanned.z, "at most 2^26: they lie too far apart");
  blocks_ = high - low;
  const float block_side = static_cast<float>(MediumVoxels::kSide) * cell_size_;
  corner_ += block_side * glm::vec3(low);
  kept_.assign(static_cast<std::size_t>(spanned.x * spanned.y * spanned.z), -1);
  for (std::size_t i = 0; i < voxels.blocks.size(); ++i) {
    const glm::ivec3 at = voxels.blocks[i] - low;
    std::int32_t& kept = kept_[blockNumber(at)];
    require(kept < 0, "block of a medium's cells", i, "at a place of its own");
    kept = static_cast<std::int32_t>(i);
  }

  densities_ = voxels.density;
  for (int axis = 0; axis < 3; ++axis) {
    if (period && axis < 2) box_.high[axis] = std::min(box_.high[axis], box_.low[axis] + (*period)[axis]);
    // What a cell holds that the box cuts lies within the box. Less than a thousandth of a cell holds next to nothing.
    std::vector<float> denser;
    for (int cell = 0; cell < MediumVoxels::kSide * blocks_[axis]; ++cell) {
      const float start = corner_[axis] + static_cast<float>(cell) * cell_size_;
      const float inside = std::min(start + cell_size_, box_.high[axis]) - std::max(start, box_.low[axis]);
      denser.push_back(1.f / std::clamp(inside / cell_size_, 1e-3f, 1.f));
    }
    for (std::size_t i = 0; i < densities_.size(); ++i) {
      const glm::ivec3 in_block(i / 64 % 8, i / 8 % 8, i % 8);
      const glm::ivec3 block = voxels.blocks[i / MediumVoxels::kCells] - low;
      densities_[i] *= denser[static_cast<std::size_t>(MediumVoxels::kSide * block[axis] + in_block[axis])];
    }
  }
  if (voxels.leaves.empty()) return;
  turned_.reserve(densities_.size());
  for (std::size_t i = 0; i < densities_.size(); ++i)
    turned_.push_back(densities_[i] > 0.f ? LeafEllipsoid(voxels.leaves[i], densities_[i]) : LeafEllipsoid());
  densities_ = {};
}

std::size_t MediumField::blockNumber(const glm::ivec3& block) const {
  const auto x = static_cast<std::size_t>(block.x), y = static_cast<std::size_t>(block.y);
  return (x * static_cast<std::size_t>(blocks_.y) + y) * static_cast<std::size_t>(blocks_.z) +
         static_cast<std::size_t>(block.z);
}

// `segment(cell, start, end)` of what lies between two distances along a ray that stays inside of the box there.
template <typename Segment>
bool MediumField::stretch(const Ray& ray, float start, float end, const Segment& segment) const {
  if (blocks_.x == 0) return segment(0u, start, end);
  constexpr int kSide = MediumVoxels::kSide;
  return ray.throughCells(corner_, kSide * cell_size_, glm::ivec3(0), blocks_ - 1, start, end,
                          [&](const glm::ivec3& block, float from, float to) {
                            const std::int32_t kept = kept_[blockNumber(block)];
                            if (kept < 0) return false;
                            const glm::vec3 low = corner_ + static_cast<float>(kSide) * cell_size_ * glm::vec3(block);
                            return ray.throughCells(
                                low, cell_size_, glm::ivec3(0), glm::ivec3(kSide - 1), from, to,
                                [&](const glm::ivec3& cell, float a, float b) {
                                  const int number = 64 * cell.x + 8 * cell.y + cell.z;
                                  const auto of_block = static_cast<std::size_t>(kept) * MediumVoxels::kCells;
                                  return segment(
                                      static_cast<std::uint32_t>(of_block + static_cast<std::size_t>(number)), a, b);
                                });
                          });
}

template <typename Segment>
void MediumField::walk(const glm::vec3& from, const glm::vec3& direction, const Segment& segment) const {
  float start = 0.f, end = kInfinity;
  const Ray whole(from, direction);
  if (!whole.clip(2, box_.low.z, box_.high.z, start, end)) return;
  if (!period_) {
    if (whole.clip(0, box_.low.x, box_.high.x, start, end) && whole.clip(1, box_.low.y, box_.high.y, start, end))
      stretch(whole, start, end, segment);
    return;
  }
  glm::vec3 point = from + start * direction;
  for (int axis = 0; axis < 2; ++axis)
    point[axis] -= (*period_)[axis] * std::floor((point[axis] - box_.low[axis]) / (*period_)[axis]);
  for (int passed = 0; passed < kMostPeriods; ++passed) {
    const Ray ray(point, direction);
    const auto wall = [&](int axis) {
      return std::max(0.f, ray.toPlane(axis, box_.low[axis] + (direction[axis] > 0.f ? (*period_)[axis] : 0.f)));
    };
    const float x = wall(0), y = wall(1), to_wall = std::min(x, y), left = end - start;
    float a = 0.f, b = std::min(to_wall, left);
    if (ray.clip(0, box_.low.x, box_.high.x, a, b) && ray.clip(1, box_.low.y, box_.high.y, a, b) &&
        stretch(ray, a, b, [&](std::uint32_t cell, float c, float d) { return segment(cell, start + c, start + d); }))
      return;
    if (left <= to_wall) return;
    start += to_wall;
    point += to_wall * direction;
    const int axis = x <= y ? 0 : 1;
    point[axis] = box_.low[axis] + (direction[axis] > 0.f ? 0.f : (*period_)[axis]);
  }
}

float MediumField::projection(const glm::vec3& direction) const {
  if (!leaves()) return 1.f;
  return rings_ ? rings_->projection(direction) : 0.5f;
}

// `visit(cell, extinction [1/m], start, end)` along a ray until it answers true.
template <typename Visit>
void MediumField::extinctions(const glm::vec3& from, const glm::vec3& direction, const Visit& visit) const {
  if (!turned_.empty()) {
    walk(from, direction, [&](std::uint32_t cell, float start, float end) {
      return visit(cell, glm::length(turned_[cell].seen(direction)), start, end);
    });
    return;
  }
  const float seen = projection(direction);
  if (densities_.empty()) {
    walk(from, direction,
         [&](std::uint32_t cell, float start, float end) { return visit(cell, seen * density_, start, end); });
    return;
  }
  walk(from, direction,
       [&](std::uint32_t cell, float start, float end) { return visit(cell, seen * densities_[cell], start, end); });
}

Collision MediumField::fly(const glm::vec3& from, const glm::vec3& direction, float depth) const {
  Collision collision;
  extinctions(from, direction, [&](std::uint32_t cell, float extinction, float start, float end) {
    const float passed = extinction > 0.f ? extinction * (end - start) : 0.f;
    if (passed <= depth) {
      depth -= passed;
      return false;
    }
    collision = {.distance = std::min(start + depth / extinction, end), .cell = cell};
    return true;
  });
  return collision;
}

float MediumField::depth(const glm::vec3& from, const glm::vec3& direction) const {
  float sum = 0.f;
  extinctions(from, direction, [&](std::uint32_t, float extinction, float start, float end) {
    if (extinction > 0.f) sum += extinction * (end - start);  // however long the way through nothing
    return sum > 128.f;                                       // lets nothing through
  });
  return sum;
}

glm::vec3 MediumField::normal(std::uint32_t cell, const glm::vec3& direction, PathRandom& random) const {
  if (!turned_.empty()) {
    const glm::vec3 n = turned_[cell].normal(direction, random);
    return glm::dot(n, direction) > 0.f ? -n : n;
  }
  if (!rings_) return lambertDirection(-direction, random);
  const glm::vec3 n = rings_->normal(direction, random);
  return glm::dot(n, direction) > 0.f ? -n : n;
}

}  // namespace sunfleck::detail
