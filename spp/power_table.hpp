#pragma once

#include <functional>
#include <vector>

#include "core/leaf_optics.hpp"
#include "spp/slab.hpp"
#include "spp/stream_constants.hpp"

namespace sunfleck::spp {

#define SHARED_FN inline
#define SHARED_IN(Type) const Type&
#define SHARED_CONSTANT inline constexpr
#include "spp/power_table.glsl"
#undef SHARED_FN
#undef SHARED_IN
#undef SHARED_CONSTANT

// (R27) Diffuse P+ and P- [F] over depth and thickness, in crossings, of slabs of one kind of leaves under a beam
// across them: row after row of one thickness, the nodes of power_table.glsl.
struct PowerTable {
  std::vector<SlabPowers> nodes;

  // Between the nodes; as shaders do.
  SlabPowers at(float depth, float thickness) const;
};

// The nodes, in crossings: thicknesses from 0 to infinity, and depths in a slab from 0 to all of it.
std::vector<double> tableThicknesses();
std::vector<double> tableDepths(double thickness);

// Leaves of all directions alike, as the models have them, lit along the slab's normal.
BeamInMedium sphericalLeaves(const LeafOptics& optics);

// A table for a kind of leaves: refinedPowerTable, or of the exact solution that of render/compare/exact_powers.hpp.
using PowerTableOf = std::function<PowerTable(const LeafOptics&)>;

// Powers of (S13) with two streams in each half.
PowerTable streamPowerTable(const LeafOptics& optics);

// (S15) Powers of SPP refined: those of the radiance that the light scattered by SPP's field makes (S10).
PowerTable refinedPowerTable(const LeafOptics& optics);

}  // namespace sunfleck::spp
