#include "field/ground_light.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "field/sphere_ordinates.hpp"

namespace sunfleck {
namespace {

constexpr std::size_t kChunks = 16;  // whose light is summed one after the other, whatever the threads

// Takes power where it meets the ground, and shares it among the four nearest cells.
class Ground {
 public:
  Ground(const GroundGrid& grid, bool periodic)
      : grid_(grid),
        periodic_(periodic),
        power_(static_cast<std::size_t>(grid.size.x) * static_cast<std::size_t>(grid.size.y), glm::vec3(0.f)) {}

  //   along  in which light travels from `place`; z < 0
  void add(const glm::vec3& place, const Direction& along, const glm::vec3& power) {
    const float way = std::max((place.z - grid_.height) / -along.z, 0.f);
    const glm::vec2 at = (glm::vec2(place + way * along) - grid_.low) / grid_.cell_size;
    if (!periodic_ && (at.x < 0.f || at.y < 0.f || at.x > static_cast<float>(grid_.size.x) ||
                       at.y > static_cast<float>(grid_.size.y)))
      return;
    if (!(glm::dot(at, at) < 1e12f)) return;  // as good as level
    const glm::vec2 low = glm::floor(at - 0.5f), part = at - 0.5f - low;
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 2; ++x) {
        const float share = (x == 0 ? 1.f - part.x : part.x) * (y == 0 ? 1.f - part.y : part.y);
        power_[cellOf(glm::ivec2(low) + glm::ivec2(x, y))] += share * power;
      }
  }
  void add(const Ground& other) {
    for (std::size_t i = 0; i < power_.size(); ++i) power_[i] += other.power_[i];
  }
  std::vector<glm::vec3> irradiance() && {
    for (glm::vec3& value : power_) value /= grid_.cell_size.x * grid_.cell_size.y;
    return std::move(power_);
  }

 private:
  std::size_t cellOf(glm::ivec2 cell) const {
    cell = periodic_ ? (cell % grid_.size + grid_.size) % grid_.size : glm::clamp(cell, glm::ivec2(0), grid_.size - 1);
    return static_cast<std::size_t>(cell.y) * static_cast<std::size_t>(grid_.size.x) + static_cast<std::size_t>(cell.x);
  }

  GroundGrid grid_;
  bool periodic_;
  std::vector<glm::vec3> power_;
};

// Calls add(ground, i) for i below count, in parallel, and sums what the ground receives.
template <typename Add>
std::vector<glm::vec3> summed(const GroundGrid& grid, bool periodic, std::size_t count, const Add& add) {
  std::vector<Ground> chunks(kChunks, Ground(grid, periodic));
  tbb::parallel_for(std::size_t{0}, kChunks, [&](std::size_t chunk) {
    for (std::size_t i = count * chunk / kChunks; i < count * (chunk + 1) / kChunks; ++i) add(chunks[chunk], i);
  });
  for (std::size_t chunk = 1; chunk < kChunks; ++chunk) chunks[0].add(chunks[chunk]);
  return std::move(chunks[0]).irradiance();
}

// The directions that go down, and their weights.
struct Downward {
  std::vector<Direction> along;
  std::vector<float> weight;
  Downward() {
    const SphereOrdinates ordinates;
    for (std::size_t i = 0; i < ordinates.size(); ++i)
      if (ordinates.weight(i) > 0.f && ordinates.direction(i).z < 0.f) {
        along.push_back(ordinates.direction(i));
        weight.push_back(ordinates.weight(i));
      }
  }
};

// Share of the light sent all over a cell along `along` that leaves the cells.
//   extinction  of each slot, in this direction [1/m]
template <typename Extinction>
float leaving(const SweepGrid& grid, std::uint32_t cell, const Direction& along, const Extinction& extinction) {
  constexpr float kDark = 20.f;  // depth beyond which nothing comes through [1]
  const auto number = static_cast<int>(cell);
  glm::ivec3 at(number % grid.size.x, number / grid.size.x % grid.size.y, number / (grid.size.x * grid.size.y));
  glm::vec3 next(std::numeric_limits<float>::max()), step(next);  // ways to the next walls, and between walls [m]
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(along[axis]) > 1e-6f) {
      step[axis] = grid.side[axis] / std::abs(along[axis]);
      next[axis] = 0.5f * step[axis];
    }
  const auto sigma = [&] {
    const auto place = static_cast<std::size_t>((at.z * grid.size.y + at.y) * grid.size.x + at.x);
    return grid.slot[place] == SweepGrid::kEmpty ? 0.f : extinction(grid.slot[place]);
  };
  float way = std::min({next.x, next.y, next.z}), depth = 0.f;
  const float own = 2.f * way * sigma();  // from end to end, through the middle
  for (;;) {
    const int axis = next.x <= next.y && next.x <= next.z ? 0 : next.y <= next.z ? 1 : 2;
    at[axis] += along[axis] > 0.f ? 1 : -1;
    next[axis] += step[axis];
    if (grid.periodic && axis < 2)
      at[axis] = (at[axis] + grid.size[axis]) % grid.size[axis];
    else if (at[axis] < 0 || at[axis] >= grid.size[axis])
      break;
    const float leave = std::min({next.x, next.y, next.z});
    depth += sigma() * (leave - way);
    way = leave;
    if (depth > kDark) return 0.f;
  }
  return std::exp(-depth) * (own > 1e-3f ? (1.f - std::exp(-own)) / own : 1.f - 0.5f * own);
}

}  // namespace

// (F31)
std::vector<glm::vec3> groundLight(const GroundGrid& grid, bool periodic, const StandElements& stand,
                                   const LineExchange& exchange, std::span<const glm::vec3> radiance) {
  const auto line_power = static_cast<float>(exchange.line_power);
  return summed(grid, periodic, stand.elements.size(), [&](Ground& ground, std::size_t element) {
    for (std::size_t side = 2 * element; side < 2 * element + 2; ++side)
      for (std::uint64_t i = exchange.first_outside[side]; i < exchange.first_outside[side + 1]; ++i) {
        const Direction& from_outside = exchange.directions[exchange.outside[i]];
        if (from_outside.z > 0.f)
          ground.add(stand.elements.centre[element], -from_outside, line_power * radiance[side]);
      }
  });
}

// (F31)
std::vector<float> groundShares(const CellMedium& medium, std::span<const float> clumping) {
  const Downward down;
  const std::size_t directions = down.along.size(), slots = medium.grid.cells.size();
  std::vector<float> extinction(slots * directions, 0.f), shares(slots * directions);
  tbb::parallel_for(std::size_t{0}, slots, [&](std::size_t slot) {
    for (std::uint32_t i = medium.first_piece[slot]; i < medium.first_piece[slot + 1]; ++i) {
      const CellPiece& piece = medium.pieces[i];
      const float area = clumping[medium.material[piece.element] / 2] * piece.area;
      for (std::size_t k = 0; k < directions; ++k)
        extinction[slot * directions + k] +=
            area * std::abs(glm::dot(medium.normal[piece.element], down.along[k])) / medium.grid.volume();
    }
  });
  tbb::parallel_for(std::size_t{0}, slots, [&](std::size_t slot) {
    for (std::size_t k = 0; k < directions; ++k)
      shares[slot * directions + k] =
          leaving(medium.grid, medium.grid.cells[slot], down.along[k],
                  [&](std::uint32_t other) { return extinction[std::size_t{other} * directions + k]; });
  });
  return shares;
}

// (F31)
std::vector<glm::vec3> groundLight(const GroundGrid& grid, const CellMedium& medium, std::span<const float> clumping,
                                   std::span<const float> shares, std::span<const glm::vec3> radiance) {
  constexpr float kLeast = 1e-3f;  // share that counts [1]
  const Downward down;
  const std::size_t directions = down.along.size();
  return summed(grid, medium.grid.periodic, medium.grid.cells.size(), [&](Ground& ground, std::size_t slot) {
    std::vector<std::size_t> open;
    for (std::size_t k = 0; k < directions; ++k)
      if (shares[slot * directions + k] > kLeast) open.push_back(k);
    if (open.empty()) return;
    std::vector<glm::vec3> sent(open.size(), glm::vec3(0.f));  // power by the weight of the direction
    for (std::uint32_t i = medium.first_piece[slot]; i < medium.first_piece[slot + 1]; ++i) {
      const CellPiece& piece = medium.pieces[i];
      const float area = clumping[medium.material[piece.element] / 2] * piece.area;
      const glm::vec3 &front = radiance[2 * std::size_t{piece.element}],
                      &back = radiance[2 * std::size_t{piece.element} + 1];
      for (std::size_t n = 0; n < open.size(); ++n) {
        const float cosine = glm::dot(medium.normal[piece.element], down.along[open[n]]);
        sent[n] += area * std::abs(cosine) * (cosine > 0.f ? front : back);
      }
    }
    const auto cell = static_cast<int>(medium.grid.cells[slot]);
    const glm::ivec3 size = medium.grid.size;
    const glm::vec3 middle =
        medium.grid.low +
        medium.grid.side * (glm::vec3(cell % size.x, cell / size.x % size.y, cell / (size.x * size.y)) + 0.5f);
    for (std::size_t n = 0; n < open.size(); ++n)
      ground.add(middle, down.along[open[n]], (shares[slot * directions + open[n]] * down.weight[open[n]]) * sent[n]);
  });
}

}  // namespace sunfleck
