#pragma once

#include <array>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "core/random.hpp"
#include "plants/weber_penn.hpp"

namespace sunfleck::detail {

// A place on a stem with right-handed orthonormal axes: `along` is where the stem goes, and turning about `right` by a
// positive angle bends a stem that leans outward further down.
struct Frame {
  glm::dvec3 position{0.};  // [m]
  glm::dvec3 right{1., 0., 0.};
  glm::dvec3 along{0., 0., 1.};

  glm::dvec3 up() const { return glm::cross(along, right); }
  void turn(const glm::dvec3& unit_axis, double angle);  // about an axis through the position, angle in [rad]
};

double radians(double degrees);
// Uniform in [-range, range].
double vary(Random& random, double range);
// Weber & Penn's ShapeRatio: share of the full length of a branch, `ratio` 0 at the top of the crown, 1 at its base.
double shapeRatio(WeberPenn::Shape shape, double ratio);
// Angle between the frame and the vertical, 0 when it points up [rad].
double declination(const Frame& frame);

// A stem about to grow.
struct Bud {
  Frame base;
  int level = 0;
  double length = 0.;  // [m]
  double radius = 0.;  // at its base [m]
};

struct Station {
  Frame frame;      // of the segment that begins here; at the tip, of the last one
  double distance;  // from the stem's base, along the stem [m]
};

// One of the parallel runs of a stem that has split, from its split (or the stem's base) to its tip.
using Strand = std::vector<Station>;

// Radius of a stem at the share z [1] of its length: taper, and flare on the trunk.
double radiusAt(const WeberPenn& parameters, const Bud& bud, double z);

// What is left over of a fractional number of splits, by level, carried to the next segment (Floyd & Steinberg).
using SplitDebt = std::array<double, 4>;

// The strands of a stem: curve, curve-back, random turns, attraction, splits.
std::vector<Strand> growStem(const WeberPenn& parameters, const Bud& bud, SplitDebt& debt, Random& random);

// The frame `distance` [m] along the stem; `distance` lies within the strand.
Frame frameAt(const Strand& strand, double distance);

}  // namespace sunfleck::detail
