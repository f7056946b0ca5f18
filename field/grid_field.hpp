#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/leaf_optics.hpp"
#include "core/progress.hpp"
#include "core/shared_progress.hpp"
#include "field/cell_medium.hpp"
#include "field/sphere_ordinates.hpp"
#include "field/sweep.hpp"

namespace sunfleck {

// What the trees of a kind do to light of one band.
struct GridOptics {
  LeafOptics leaf{};
  float wood_reflectance = 0.3f;  // Lambertian [1], 0 .. 1
};

// Light that comes to a field, in all bands at once. Figures of elements stand at (element * 2 + side) * bands + band;
// side 0 is the front.
struct GridLight {
  std::vector<std::vector<GridOptics>> optics;  // of each band and kind
  // Irradiance that comes straight from the sun, of each element, side and band; of wood on its whole surface.
  std::vector<float> direct;
  EnteringLight entering;  // what comes from the sky and the ground
  std::size_t bands() const { return optics.size(); }
};

struct GridEffort {
  // Bound on the sum of absolute errors of all elements' irradiances, weighted by area, by their sum [1].
  float error = 0.005f;
  int iterations = 100;  // at most
};

// Where the light of one band ends up, as a share of what comes [1].
struct GridBalance {
  double incoming = 0.;  // power that comes, in the unit of irradiance times m^2; nothing else is in it
  double absorbed_leaves = 0., absorbed_wood = 0., absorbed_ground = 0.;
  double arriving_ground = 0.;
  double upward = 0.;     // leaves through the top
  double elsewhere = 0.;  // leaves through sides and, without ground, the bottom
  double residual() const { return 1. - absorbed_leaves - absorbed_wood - absorbed_ground - upward - elsewhere; }
};

struct GridSolution {
  std::vector<float> irradiance;     // of each element, side and band, direct light included; of wood all is in front
  std::vector<GridBalance> balance;  // of each band
  std::vector<float> ground_irradiance;  // of each column of cells and band
  int iterations = 0;                    // times that light was followed through the grid
  double error_bound = 0.;               // see GridEffort::error; larger than asked for only if `told`
  std::string told;                      // why there is no steady state, or none was found
};

// A sun of irradiance 1 on a plane that faces it, as it comes through the cells.
struct CellSun {
  std::vector<float> direct;  // irradiance of each element and side
  std::vector<float> ground;  // of each column of cells
};

// (F17) Light among leaves by discrete ordinates in the cells of a CellMedium alone, quick and some per cent off. All
// that depends on neither light nor optics is kept. The same to the bit for any number of threads; not to be used by
// several at once.
class GridField {
 public:
  static constexpr std::size_t kMostBands = 4;

  //   clumping  Omega of each kind of tree [1], 0 .. 1; see clumping()
  GridField(CellMedium medium, std::span<const float> clumping, const SphereOrdinates& ordinates = SphereOrdinates());
  ~GridField();
  GridField(GridField&&) noexcept;
  GridField& operator=(GridField&&) noexcept;

  const CellMedium& medium() const { return medium_; }
  const SphereOrdinates& ordinates() const { return ordinates_; }

  // Throws InvalidInput on no band or more than kMostBands, a share out of its range, light that is not finite or
  // negative, arrays that do not fit the medium, and on more memory than there is; std::runtime_error("interrupted")
  // when `progress`, told after each iteration and asked within, ends it.
  GridSolution solve(const GridLight& light, const GridEffort& effort = {}, const Progress& progress = {});

  // (F21) Direct light by extinction in the cells: for media of turbid leaves, and for stands in which the light of
  // single leaves does not count. Throws InvalidInput on a direction that is not a unit vector that goes down.
  CellSun sunThroughCells(const Direction& along) const;

  // Light of even radiance from everywhere above, for each band [radiance]; beyond the sides of a single stand the
  // ground sends up `ground` [radiance].
  EnteringLight evenSky(std::span<const float> sky, std::span<const float> ground,
                        std::vector<float> ground_albedo) const;

  // What is kept and made by a solution of so many bands [byte].
  double memoryBytes(std::size_t bands) const;

 private:
  struct State;
  void validate(const GridLight& light) const;
  void step(State& state, const GridLight& light, SharedProgress& progress);
  void settleCells(const GridLight& light, std::size_t band, std::span<const float> x, std::span<float> g) const;

  CellMedium medium_;
  SphereOrdinates ordinates_;
  std::vector<float> clumping_;    // Omega of each slot
  std::vector<float> fullness_;    // of each element: see detail/cell_exchange.hpp
  std::vector<float> staying_;     // share of what the leaves of each slot send that they meet themselves at once
  std::vector<float> extinction_;  // of each slot, Omega included, as the sweep reads it
};

}  // namespace sunfleck
