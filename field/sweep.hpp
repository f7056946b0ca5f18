#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "field/sphere_ordinates.hpp"

namespace sunfleck {

// Box-shaped cells that light is followed through. Only cells that hold something have a slot, where figures are kept;
// light passes the others as it came. Cell (x, y, z) is number (z * size.y + y) * size.x + x.
struct SweepGrid {
  glm::vec3 low{0.f};     // corner of cell (0, 0, 0) [m]
  glm::vec3 side{1.f};    // sides of a cell [m]
  glm::ivec3 size{1};     // [cell]
  bool periodic = false;  // whether it repeats without end in x and y

  static constexpr std::uint32_t kEmpty = ~0u;
  std::vector<std::uint32_t> slot;   // of each cell, or kEmpty
  std::vector<std::uint32_t> cells;  // number of the cell of each slot, in order

  std::size_t count() const {
    return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z);
  }
  float volume() const { return side.x * side.y * side.z; }  // of a cell [m^3]
};

// What enters a grid from outside. Radiance of direction i and band b stands at (row * bands + b) * kLanes + lane.
struct EnteringLight {
  // Through the top, through the sides of a grid that does not repeat, and through the bottom where there is no ground.
  std::vector<float> radiance;
  std::vector<float> ground_albedo;  // Lambertian, of each band [1]; empty: no ground at the bottom
  // Light that has come to the ground by other ways, such as straight from the sun: irradiance of each column of cells
  // (y, x) and band, in the radiance's unit times sr. Empty: none.
  std::vector<float> ground_irradiance;
};

// (F14) Light through a grid by discrete ordinates: for each direction s, s . grad I = -sigma I + Q, by diamond
// differences with a balanced set-to-zero fix-up. The same to the bit for any number of threads.
class Sweep {
 public:
  Sweep(SweepGrid grid, const SphereOrdinates& ordinates, std::size_t bands);

  const SweepGrid& grid() const { return grid_; }
  std::size_t bands() const { return bands_; }
  std::size_t slots() const { return grid_.cells.size(); }

  // What a sweep of so many slots takes with its source, extinction and mean radiance [byte].
  static double memoryBytes(const SweepGrid& grid, const SphereOrdinates& ordinates, std::size_t bands);

  // Where the figures of a slot stand. Extinction is that of a direction and its opposite.
  std::size_t extinctionPlace(std::size_t row, std::size_t slot) const;
  std::size_t place(std::size_t row, std::size_t slot) const { return (row * slots() + slot) * stride_; }
  std::size_t extinctionSize() const { return ordinates_.rows() / 2 * slots() * SphereOrdinates::kLanes; }
  std::size_t size() const { return ordinates_.rows() * slots() * stride_; }

  // Follows the light once from one end of the grid to the other. In a periodic grid what enters at a side is what left
  // the other when last followed.
  //   extinction  sigma [1/m], at extinctionPlace() + lane
  //   source      Q [radiance/m], at place() + band * kLanes + lane
  //   mean        to be written: mean radiance in each cell that has a slot; likewise
  void follow(std::span<const float> extinction, std::span<const float> source, const EnteringLight& entering,
              std::span<float> mean);

  // Power of one band that left the grid when last followed, through its bottom, where the ground may send it back, its
  // top and, unless it repeats, its sides [radiance sr m^2].
  struct Powers {
    double bottom = 0., top = 0., sides = 0.;
  };
  Powers leaving(std::size_t band) const;
  // Power of one band that enters, what the ground sends up not counted [radiance sr m^2].
  double enteringPower(const EnteringLight& entering, std::size_t band) const;
  // Irradiance of each column's ground and band, entering.ground_irradiance included.
  std::span<const float> groundIrradiance() const { return ground_; }

  // Radiance at the sides of a periodic grid, which the next sweep begins with, and how far the last one has changed
  // it: the sum of the changes of power of one band [radiance sr m^2].
  std::span<float> walls() { return walls_; }
  double wallChange(std::size_t band) const;

 private:
  void enter(std::size_t row, const EnteringLight& entering);
  void sweepRows(std::size_t begin, std::size_t end, std::span<const float> extinction, std::span<const float> source,
                 std::span<float> mean);
  void light(const EnteringLight& entering);
  template <typename Value>
  double throughSides(std::size_t row, std::size_t band, const Value& value) const;
  double throughLevel(std::size_t row, std::size_t band) const;
  std::size_t wallPlace(std::size_t row) const { return row * wall_size_; }

  SweepGrid grid_;
  SphereOrdinates ordinates_;
  std::size_t bands_, stride_, wall_size_, level_size_;
  std::vector<float> walls_;   // of each row: its faces across x, then those across y
  std::vector<float> before_;  // the same before the last sweep
  std::vector<float> levels_;  // of each row: its faces across z
  std::vector<float> ground_;  // of each column and band
};

}  // namespace sunfleck
