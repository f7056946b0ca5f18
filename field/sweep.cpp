#include "field/sweep.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "field/detail/sweep_row.hpp"

namespace sunfleck {
namespace {

constexpr std::size_t kLanes = SphereOrdinates::kLanes;
static_assert(kLanes == detail::kSweepLanes);
// Columns of cells that one task sweeps: wide enough that a task takes far longer than to start it.
constexpr int kTile = 16;

std::size_t area(int a, int b) {
  return static_cast<std::size_t>(a) * static_cast<std::size_t>(b);
}

}  // namespace

Sweep::Sweep(SweepGrid grid, const SphereOrdinates& ordinates, std::size_t bands)
    : grid_(std::move(grid)),
      ordinates_(ordinates),
      bands_(bands),
      stride_(bands * kLanes),
      wall_size_((area(grid_.size.z, grid_.size.y) + area(grid_.size.z, grid_.size.x)) * stride_),
      level_size_(area(grid_.size.y, grid_.size.x) * stride_),
      walls_(ordinates_.rows() * wall_size_),
      levels_(ordinates_.rows() * level_size_),
      ground_(area(grid_.size.y, grid_.size.x) * bands) {}

double Sweep::memoryBytes(const SweepGrid& grid, const SphereOrdinates& ordinates, std::size_t bands) {
  const auto x = static_cast<double>(grid.size.x), y = static_cast<double>(grid.size.y),
             z = static_cast<double>(grid.size.z);
  const double lanes = static_cast<double>(ordinates.size()), sets = static_cast<double>(bands);
  const double of_slots = static_cast<double>(grid.cells.size()) * lanes * (2. * sets + 0.5);
  const double of_faces = lanes * sets * ((grid.periodic ? 2. : 1.) * z * (x + y) + x * y);
  return 4. * (of_slots + of_faces + x * y * z);
}

std::size_t Sweep::extinctionPlace(std::size_t row, std::size_t slot) const {
  return (std::min(row, ordinates_.opposite(row)) * slots() + slot) * kLanes;
}

// Fills what enters the grid in the directions of a row; its sides keep what left them where the grid is periodic.
void Sweep::enter(std::size_t row, const EnteringLight& entering) {
  const float* const radiance = entering.radiance.data() + row * stride_;
  float* const wall = walls_.data() + wallPlace(row);
  float* const level = levels_.data() + row * level_size_;
  if (!grid_.periodic)
    for (std::size_t at = 0; at < wall_size_; at += stride_) std::copy_n(radiance, stride_, wall + at);
  if (ordinates_.direction(row * kLanes).z < 0.f || entering.ground_albedo.empty()) {
    for (std::size_t at = 0; at < level_size_; at += stride_) std::copy_n(radiance, stride_, level + at);
    return;
  }
  // What the ground sends up, normalised by the flux of these very directions, so that none is lost or made.
  for (std::size_t column = 0; column < area(grid_.size.y, grid_.size.x); ++column)
    for (std::size_t band = 0; band < bands_; ++band) {
      const float up =
          entering.ground_albedo[band] * ground_[column * bands_ + band] / static_cast<float>(ordinates_.halfFlux(2));
      std::fill_n(level + (column * bands_ + band) * kLanes, kLanes, up);
    }
}

void Sweep::sweepRows(std::size_t begin, std::size_t end, std::span<const float> extinction,
                      std::span<const float> source, std::span<float> mean) {
  const detail::SweepRow sweep = detail::sweepRow();
  const glm::ivec2 tiles((grid_.size.x + kTile - 1) / kTile, (grid_.size.y + kTile - 1) / kTile);
  // Tiles on a diagonal need those of the diagonals before alone.
  for (int diagonal = 0; diagonal < tiles.x + tiles.y - 1; ++diagonal) {
    const int first = std::max(0, diagonal - tiles.y + 1), last = std::min(diagonal, tiles.x - 1);
    const auto across = static_cast<std::size_t>(last - first + 1);
    tbb::parallel_for(std::size_t{0}, (end - begin) * across, [&](std::size_t task) {
      const std::size_t row = begin + task / across;
      glm::ivec2 tile(first + static_cast<int>(task % across), 0);
      tile.y = diagonal - tile.x;
      const Direction& s = ordinates_.direction(row * kLanes);
      detail::SweptRow swept{.size = grid_.size,
                             .backward = {s.x < 0.f, s.y < 0.f, s.z < 0.f},
                             .slot = grid_.slot.data(),
                             .none = SweepGrid::kEmpty,
                             .extinction = extinction.data() + extinctionPlace(row, 0),
                             .source = source.data() + place(row, 0),
                             .mean = mean.data() + place(row, 0),
                             .face_x = walls_.data() + wallPlace(row),
                             .face_y = walls_.data() + wallPlace(row) + area(grid_.size.z, grid_.size.y) * stride_,
                             .face_z = levels_.data() + row * level_size_,
                             .bands = bands_};
      for (int a = 0; a < 3; ++a)
        for (std::size_t lane = 0; lane < kLanes; ++lane)
          swept.rate[a][lane] =
              std::abs(ordinates_.direction(row * kLanes + lane)[a]) / (detail::kOutwardShare * grid_.side[a]);
      if (swept.backward[0]) tile.x = tiles.x - 1 - tile.x;
      if (swept.backward[1]) tile.y = tiles.y - 1 - tile.y;
      sweep(swept, tile * kTile, glm::min((tile + 1) * kTile, glm::ivec2(grid_.size)));
    });
  }
}

// Irradiance of the ground by what has come down.
void Sweep::light(const EnteringLight& entering) {
  if (entering.ground_irradiance.empty())
    std::fill(ground_.begin(), ground_.end(), 0.f);
  else
    std::copy(entering.ground_irradiance.begin(), entering.ground_irradiance.end(), ground_.begin());
  for (std::size_t row = 0; row < ordinates_.rows(); ++row) {
    if (ordinates_.direction(row * kLanes).z > 0.f) continue;
    const float* const level = levels_.data() + row * level_size_;
    for (std::size_t i = 0; i < ground_.size(); ++i)
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const std::size_t direction = row * kLanes + lane;
        ground_[i] += ordinates_.weight(direction) * -ordinates_.direction(direction).z * level[i * kLanes + lane];
      }
  }
}

// Power through the sides of what `value` tells of each face and lane.
template <typename Value>
double Sweep::throughSides(std::size_t row, std::size_t band, const Value& value) const {
  const std::size_t across_x = area(grid_.size.z, grid_.size.y), all = across_x + area(grid_.size.z, grid_.size.x);
  double power = 0.;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const Direction& s = ordinates_.direction(row * kLanes + lane);
    double x = 0., y = 0.;
    for (std::size_t face = 0; face < all; ++face)
      (face < across_x ? x : y) += value(wallPlace(row) + face * stride_ + band * kLanes + lane);
    power += double{ordinates_.weight(row * kLanes + lane)} * double{grid_.side.z} *
             (x * double{std::abs(s.x)} * double{grid_.side.y} + y * double{std::abs(s.y)} * double{grid_.side.x});
  }
  return power;
}

double Sweep::throughLevel(std::size_t row, std::size_t band) const {
  double power = 0.;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const std::size_t direction = row * kLanes + lane;
    double sum = 0.;
    for (std::size_t at = band * kLanes + lane; at < level_size_; at += stride_)
      sum += double{levels_[row * level_size_ + at]};
    power += double{ordinates_.weight(direction)} * double{std::abs(ordinates_.direction(direction).z)} * sum *
             double{grid_.side.x} * double{grid_.side.y};
  }
  return power;
}

void Sweep::follow(std::span<const float> extinction, std::span<const float> source, const EnteringLight& entering,
                   std::span<float> mean) {
  const std::size_t rows = ordinates_.rows();
  if (grid_.periodic) before_ = walls_;
  const auto begin = [&](std::size_t from, std::size_t to) {
    tbb::parallel_for(from, to, [&](std::size_t row) { enter(row, entering); });
  };
  // Octants 0 .. 3 go up, 4 .. 7 down.
  begin(rows / 2, rows);
  if (entering.ground_albedo.empty()) {
    begin(0, rows / 2);
    sweepRows(0, rows, extinction, source, mean);
    light(entering);
  } else {
    sweepRows(rows / 2, rows, extinction, source, mean);
    light(entering);
    begin(0, rows / 2);
    sweepRows(0, rows / 2, extinction, source, mean);
  }
}

Sweep::Powers Sweep::leaving(std::size_t band) const {
  Powers powers;
  for (std::size_t row = 0; row < ordinates_.rows(); ++row) {
    (ordinates_.direction(row * kLanes).z < 0.f ? powers.bottom : powers.top) += throughLevel(row, band);
    if (!grid_.periodic) powers.sides += throughSides(row, band, [&](std::size_t at) { return double{walls_[at]}; });
  }
  return powers;
}

double Sweep::enteringPower(const EnteringLight& entering, std::size_t band) const {
  const glm::dvec3 box = glm::dvec3(grid_.side) * glm::dvec3(grid_.size);
  const glm::dvec3 faces(grid_.periodic ? glm::dvec2(0.) : glm::dvec2(box.y * box.z, box.x * box.z), box.x * box.y);
  double power = 0.;
  for (std::size_t row = 0; row < ordinates_.rows(); ++row) {
    const bool through_level = ordinates_.direction(row * kLanes).z < 0.f || entering.ground_albedo.empty();
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const glm::dvec3 s = glm::abs(glm::dvec3(ordinates_.direction(row * kLanes + lane)));
      power += double{ordinates_.weight(row * kLanes + lane)} *
               double{entering.radiance[row * stride_ + band * kLanes + lane]} *
               (s.x * faces.x + s.y * faces.y + (through_level ? s.z * faces.z : 0.));
    }
  }
  return power;
}

double Sweep::wallChange(std::size_t band) const {
  if (!grid_.periodic) return 0.;
  double change = 0.;
  for (std::size_t row = 0; row < ordinates_.rows(); ++row)
    change +=
        throughSides(row, band, [&](std::size_t at) { return std::abs(double{walls_[at]} - double{before_[at]}); });
  return change;
}

}  // namespace sunfleck
