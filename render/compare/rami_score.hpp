#pragma once

#include "render/reference/trace_sums.hpp"

namespace sunfleck {

// What a score says of a model. `uncertain`: the reference's own error is too large to tell a good model from a bad
// one.
enum class RamiVerdict { pass, unclear, fail, uncertain };

// How far a value is from a reference.
struct RamiScore {
  double percent = 0.;  // difference by the reference
  double z = 0.;        // difference by the standard errors of both: what chance makes of two that are the same
  double z_prime = 0.;  // >= 0, see below
  RamiVerdict verdict = RamiVerdict::pass;
};

// (R13) The score of RAMI-IV: the difference by what is allowed, 3 % of the reference and its standard error u. Below 2
// passes, above 3 fails, between is unclear. When u is above those 3 %, a score below 3 rests more on the reference's
// error than on the model and tells nothing; a failure stays one. Differences by nothing are infinite.
RamiScore ramiScore(const Estimate& value, const Estimate& reference);

const char* nameOf(RamiVerdict verdict);  // "pass", "unclear", "fail", "reference too uncertain"

}  // namespace sunfleck
