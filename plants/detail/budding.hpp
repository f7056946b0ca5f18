#pragma once

#include "plants/detail/stem.hpp"

namespace sunfleck::detail {

// Turns successive children about their parent: a helix of `rotate` when positive, alternate sides when negative.
class Phyllotaxis {
 public:
  Phyllotaxis(const WeberPenn::Level& level, Random& random);

  // Directs `frame`, which lies along the parent, along the next child. `down_angle` [rad].
  void direct(Frame& frame, double down_angle, Random& random);

 private:
  double rotate_, rotate_v_;  // [deg]
  double angle_ = 0.;         // of the last child about the parent [deg]
  double side_ = 1.;
};

// The child's angle to its parent [rad]; `towards_base` is 1 at the base of the parent's branched part, 0 at its tip.
double downAngle(const WeberPenn::Level& level, double towards_base, Random& random);

// Directs `frame` along a child of a fan at the parent's tip: spread evenly over `rotate` degrees, then down by the
// child's angle. `share` [1] is its place in the fan, 0 .. 1.
void fanOut(Frame& frame, const WeberPenn::Level& level, double share, Random& random);

}  // namespace sunfleck::detail
