#include "render/compare/rami_score.hpp"

#include <cmath>
#include <limits>

namespace sunfleck {
namespace {

constexpr double kAllowed = 0.03, kPass = 2., kFail = 3.;

double byScale(double difference, double scale) {
  if (difference == 0.) return 0.;
  return scale > 0. ? difference / scale : std::copysign(std::numeric_limits<double>::infinity(), difference);
}

}  // namespace

RamiScore ramiScore(const Estimate& value, const Estimate& reference) {
  const double difference = value.value - reference.value;
  const double size = std::abs(reference.value), allowed = kAllowed * size;
  RamiScore score{.percent = 100. * byScale(difference, size),
                  .z = byScale(difference, std::hypot(value.standard_error, reference.standard_error)),
                  .z_prime = byScale(std::abs(difference), std::hypot(allowed, reference.standard_error))};
  if (score.z_prime > kFail)
    score.verdict = RamiVerdict::fail;
  else if (reference.standard_error > allowed)
    score.verdict = RamiVerdict::uncertain;
  else if (score.z_prime >= kPass)
    score.verdict = RamiVerdict::unclear;
  return score;
}

const char* nameOf(RamiVerdict verdict) {
  switch (verdict) {
    case RamiVerdict::pass:
      return "pass";
    case RamiVerdict::unclear:
      return "unclear";
    case RamiVerdict::fail:
      return "fail";
    case RamiVerdict::uncertain:
      break;
  }
  return "reference too uncertain";
}

}  // namespace sunfleck
