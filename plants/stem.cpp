#include "plants/detail/stem.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

#include "plants/detail/portable_math.hpp"

namespace sunfleck::detail {
namespace {

constexpr double kPi = std::numbers::pi;

// A strand on its way to the tip.
struct Growing {
  Strand strand;
  Frame tip;
  int segment = 0;           // the next one to grow
  double split_share = 1.;   // of the stem's seg_splits that fall to this strand
  glm::dvec2 restoring{0.};  // turn per segment that takes a split's tilt back, about the frame's (right, up) [rad]
  glm::dvec3 axis{0.};       // of a helix
};

int dueSplits(double rate, double& debt) {
  const double wanted = rate + debt;
  const int splits = std::max(0, static_cast<int>(std::lround(wanted)));
  debt = wanted - splits;
  return splits;
}

// Tilts strand `k` of `count` away from the others: around the axis of a vertical stem, side by side on a level one.
void spread(const WeberPenn::Level& level, Growing& growing, int k, int count, double roll, double divergence,
            int segments_left, Random& random) {
  const double lean = declination(growing.tip);
  const double tilt =
      std::max(0., radians(double{level.split_angle} + vary(random, double{level.split_angle_v})) - lean);
  const double around = roll + 2. * kPi * k / count;
  const glm::dvec2 axis(portable::cosine(around), portable::sine(around));
  growing.tip.turn(axis.x * growing.tip.right + axis.y * growing.tip.up(), tilt);
  growing.restoring -= axis * (tilt / std::max(1, segments_left));
  growing.tip.turn({0., 0., 1.}, (k - 0.5 * (count - 1)) * divergence * portable::sine(lean));
}

// Weber & Penn's angle between split stems about the vertical: 20 + 0.75 (30 + |declination - 90|) u^2 degrees.
double splitDivergence(const Frame& tip, Random& random) {
  const double u = random.uniformDouble();
  return radians(20.) + 0.75 * (radians(30.) + std::abs(declination(tip) - 0.5 * kPi)) * u * u;
}

int baseSplits(const WeberPenn& parameters, Random& random) {
  if (parameters.base_splits >= 0) return parameters.base_splits;
  return static_cast<int>(random.uniformDouble() * (1 - parameters.base_splits));
}

void curveSegment(const WeberPenn& parameters, const Bud& bud, Growing& growing, Random& random) {
  const WeberPenn::Level& level = parameters.level[static_cast<std::size_t>(bud.level)];
  const double segments = level.curve_res;
  double curve = double{level.curve} / segments;
  if (level.curve_back != 0.f)
    curve = 2. * double{growing.segment < 0.5 * segments ? level.curve : level.curve_back} / segments;
  Frame& tip = growing.tip;
  if (level.curve_v < 0.f) {
    constexpr double kQuarterTurn = 0.5 * kPi;
    if (growing.segment == 0)
      tip.turn(tip.right, radians(-double{level.curve_v}));
    else
      tip.turn(growing.axis, kQuarterTurn);
  } else if (growing.segment > 0 || bud.level > 0) {  // the trunk leaves the ground upright
    tip.turn(tip.right, radians(curve + vary(random, double{level.curve_v}) / segments));
    tip.turn(tip.up(), radians(vary(random, double{level.bend_v}) / segments));
  }
  tip.turn(tip.right, growing.restoring.x);
  tip.turn(tip.up(), growing.restoring.y);
  if (bud.level >= 2 && parameters.attraction_up != 0.f) {
    const double lean = declination(tip);
    const glm::dvec3 axis = glm::cross(tip.along, glm::dvec3(0., 0., 1.));
    // sin(lean): the attraction has no lever on a stem that already points up or down.
    if (glm::length(axis) > 1e-6)
      tip.turn(glm::normalize(axis), double{parameters.attraction_up} * lean * portable::sine(lean) / segments);
  }
}

}  // namespace

double radians(double degrees) {
  return degrees * kPi / 180.;
}

double vary(Random& random, double range) {
  return range * (2. * random.uniformDouble() - 1.);
}

void Frame::turn(const glm::dvec3& unit_axis, double angle) {
  const double sine = portable::sine(0.5 * angle);
  const glm::dquat rotation(portable::cosine(0.5 * angle), unit_axis.x * sine, unit_axis.y * sine, unit_axis.z * sine);
  along = glm::normalize(rotation * along);
  right = rotation * right;
  right = glm::normalize(right - glm::dot(right, along) * along);
}

double declination(const Frame& frame) {
  return portable::arccosine(std::clamp(frame.along.z, -1., 1.));
}

double shapeRatio(WeberPenn::Shape shape, double ratio) {
  const double r = std::clamp(ratio, 0., 1.);
  using enum WeberPenn::Shape;
  switch (shape) {
    case conical:
      return 0.2 + 0.8 * r;
    case spherical:
      return 0.2 + 0.8 * portable::sine(kPi * r);
    case hemispherical:
      return 0.2 + 0.8 * portable::sine(0.5 * kPi * r);
    case cylindrical:
    case envelope:
      return 1.;
    case tapered_cylindrical:
      return 0.5 + 0.5 * r;
    case flame:
      return r <= 0.7 ? r / 0.7 : (1. - r) / 0.3;
    case inverse_conical:
      return 1. - 0.8 * r;
    case tend_flame:
      return r <= 0.7 ? 0.5 + 0.5 * r / 0.7 : 0.5 + 0.5 * (1. - r) / 0.3;
  }
  return 1.;
}

double radiusAt(const WeberPenn& parameters, const Bud& bud, double z) {
  const double taper = double{parameters.level[static_cast<std::size_t>(bud.level)].taper};
  const double unit_taper = taper < 1. ? taper : taper < 2. ? 2. - taper : 0.;
  double radius = bud.radius * (1. - unit_taper * z);
  if (taper >= 1. && radius > 0.) {
    const double to_tip = (1. - z) * bud.length;
    const double depth = taper < 2. || to_tip < radius ? 1. : taper - 2.;
    const double in_bead =
        taper < 2. ? to_tip : std::abs(to_tip - 2. * radius * std::floor(to_tip / (2. * radius) + 0.5));
    if (!(taper < 2. && in_bead >= radius)) {
      const double height = in_bead - radius;
      radius = (1. - depth) * radius + depth * std::sqrt(std::max(0., radius * radius - height * height));
    }
  }
  if (bud.level == 0) {
    const double from_ground = std::max(0., 1. - 8. * z);
    radius *= 1. + double{parameters.flare} * (portable::power(100., from_ground) - 1.) / 100.;
  }
  return radius;
}

std::vector<Strand> growStem(const WeberPenn& parameters, const Bud& bud, SplitDebt& debt, Random& random) {
  const WeberPenn::Level& level = parameters.level[static_cast<std::size_t>(bud.level)];
  const double step = bud.length / level.curve_res;
  std::vector<Strand> done;
  std::vector<Growing> growing;
  growing.push_back({.strand = {}, .tip = bud.base, .axis = bud.base.along});
  const int base_splits = bud.level == 0 ? baseSplits(parameters, random) : 0;
  while (!growing.empty()) {
    Growing current = std::move(growing.back());
    growing.pop_back();
    for (; current.segment < level.curve_res; ++current.segment) {
      curveSegment(parameters, bud, current, random);
      current.strand.push_back({current.tip, current.segment * step});
      current.tip.position += step * current.tip.along;
      const int segments_left = level.curve_res - current.segment - 1;
      if (segments_left == 0) continue;
      const int splits =
          bud.level == 0 && current.segment == 0
              ? base_splits
              : dueSplits(double{level.seg_splits} * current.split_share, debt[static_cast<std::size_t>(bud.level)]);
      if (splits == 0) continue;
      // A strand's rate is divided at every split, so that strands grow in number steadily and not exponentially; this
      // follows tree-gen (Hewitt 2017).
      current.split_share /= splits + 1;
      const double roll = 2. * kPi * random.uniformDouble();
      const double divergence = splitDivergence(current.tip, random);
      for (int clone = 1; clone <= splits; ++clone) {
        Growing twin = current;
        twin.strand.clear();
        ++twin.segment;
        spread(level, twin, clone, splits + 1, roll, divergence, segments_left, random);
        growing.push_back(std::move(twin));
      }
      spread(level, current, 0, splits + 1, roll, divergence, segments_left, random);
    }
    current.strand.push_back({current.tip, bud.length});
    done.push_back(std::move(current.strand));
  }
  return done;
}

Frame frameAt(const Strand& strand, double distance) {
  const auto beyond = std::find_if(strand.begin() + 1, strand.end() - 1,
                                   [&](const Station& station) { return station.distance > distance; });
  const Station& from = *(beyond - 1);
  Frame frame = from.frame;
  frame.position += std::max(0., distance - from.distance) * frame.along;
  return frame;
}

}  // namespace sunfleck::detail
