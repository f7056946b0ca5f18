#include "plants/detail/budding.hpp"

#include <cmath>

namespace sunfleck::detail {

Phyllotaxis::Phyllotaxis(const WeberPenn::Level& level, Random& random)
    : rotate_(double{level.rotate}), rotate_v_(double{level.rotate_v}), angle_(360. * random.uniformDouble()) {}

void Phyllotaxis::direct(Frame& frame, double down_angle, Random& random) {
  if (rotate_ >= 0.) {
    angle_ = std::fmod(angle_ + rotate_ + vary(random, rotate_v_), 360.);
  } else {
    side_ = -side_;
    angle_ = side_ * (180. + rotate_ + vary(random, rotate_v_));
  }
  frame.turn(frame.along, radians(angle_));
  frame.turn(frame.right, down_angle);
}

double downAngle(const WeberPenn::Level& level, double towards_base, Random& random) {
  const double variation = double{level.down_angle_v};
  const double angle =
      variation >= 0.
          ? double{level.down_angle} + vary(random, variation)
          : double{level.down_angle} + variation * (1. - 2. * shapeRatio(WeberPenn::Shape::conical, towards_base));
  return radians(angle);
}

void fanOut(Frame& frame, const WeberPenn::Level& level, double share, Random& random) {
  const double spread = std::abs(double{level.rotate}) * (share - 0.5) + vary(random, double{level.rotate_v});
  frame.turn(frame.up(), radians(spread));
  frame.turn(frame.right, downAngle(level, 0.5, random));
}

}  // namespace sunfleck::detail
