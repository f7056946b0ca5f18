#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "core/progress.hpp"
#include "pp_solver/problem.hpp"

namespace sunfleck::pp {

namespace detail {
struct SlabTableData;
}

struct SlabTableSettings {
  double max_thickness = 16.;  // of the slabs in the table [1], 0.01 .. 1000
  // Error to reach, SlabTableErrors::bound() of radiance and of powers, above 0; 0: as small as max_bytes allows.
  double max_error = 2e-2;
  std::size_t max_bytes = std::size_t{64} << 20;  // of the values in memory and in the file, from 1 MiB
  int streams = 32;  // of the solver to begin with, 8 .. 128, even; doubled where the error asks for it
  std::string note;  // what the user calls the medium: printable, at most 200 characters
};

// By how much look-ups were off at held-out places, for a beam of irradiance 1 across it: radiance as 4 pi times the
// difference [1], powers as the difference [1]. The places are the middles of the table's cells and random ones; the
// other side is the solver with twice the streams.
struct SlabTableErrors {
  double radiance_max = 0., power_max = 0.;  // over all places
  double radiance_rms = 0., power_rms = 0.;  // over places spread evenly over thickness, depth and directions
  int places = 0;                            // directions at which radiance was compared
  // The largest error anywhere is to be expected below this: places not looked at are granted as much again.
  double bound() const { return kSafety * (radiance_max > power_max ? radiance_max : power_max); }
  static constexpr double kSafety = 2.;
};

// Radiance integrated over half of the sphere, for a beam of irradiance 1 across it [1].
struct SlabTablePowers {
  float down;    // P+, diffuse alone
  float up;      // P-
  float direct;  // the beam's own, to be added to P+
};

// (P12) The exact solution of all homogeneous slabs of one medium on black ground under a beam, for shading: diffuse
// radiance over thickness, depth, cosines of the beam and of the direction looked along, and azimuth between them; and
// powers over the first three. A value that does not change: copies share it, and any thread may ask it.
class SlabTable {
 public:
  // Solves on all threads that TBB may use; the same bits for any number of them. Nothing if `progress` says so. Throws
  // InvalidInput for a medium that is none, a hot spot (it is no property of a slab of points), settings out of range,
  // and an error that max_bytes does not allow.
  static std::optional<SlabTable> build(const decltype(Layer::medium)& medium, const SlabTableSettings& settings = {},
                                        const Progress& progress = {});

  // Diffuse radiance [1/sr] for a beam of irradiance 1 across it. Never allocates, and finite for any input: values out
  // of range are taken as the nearest within, NaN as the least.
  //   thickness  w [1], 0 .. maxThickness(); thicker slabs are taken to be just that thick
  //   depth      [1], 0 .. w
  //   mu0        |cos| of the beam to the vertical [1], 0 .. 1
  //   mu         cos of the light's travel to the downward vertical [1], -1 .. 1; 0 is just below the horizontal
  //   azimuth    of the light's travel minus that of the beam's [rad]
  float radiance(float thickness, float depth, float mu0, float mu, float azimuth) const;

  // P+ and P- [1], by the same rules.
  SlabTablePowers powers(float thickness, float depth, float mu0) const;

  float maxThickness() const;
  const SlabTableErrors& errors() const;
  const std::string& about() const;  // the medium, one line
  std::array<int, 4> nodes() const;  // over thickness, depth, mu0 and |mu|
  int azimuthModes() const;
  int streams() const;        // of the solver that made it
  std::size_t bytes() const;  // of its values

  explicit SlabTable(std::shared_ptr<const detail::SlabTableData> data) : data_(std::move(data)) {}
  const detail::SlabTableData& data() const { return *data_; }

 private:
  std::shared_ptr<const detail::SlabTableData> data_;
};

}  // namespace sunfleck::pp
