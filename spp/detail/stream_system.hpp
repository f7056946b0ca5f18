#pragma once

#include <Eigen/Core>
#include <optional>

#include "spp/stream_constants.hpp"

namespace sunfleck::spp::detail {

// Light that is scattered straight on more than this share of the time is as good as not scattered; the net flux, which
// nothing then hinders, would lose its digits.
inline constexpr double kMostForward = 1. - 1e-8;

// The equations of n streams in each half for one azimuth order, in the sum S and the difference D of the radiances
// down and up:
//   M S' = -(G - O W) D + odd_source e^-Kz,    M D' = -(G - E W) S + even_source e^-Kz
struct StreamSystem {
  Eigen::VectorXd cosines, weights, extinction;  // M, W, G of each stream
  Eigen::MatrixXd even, odd;                     // E, O
  Eigen::VectorXd even_source, odd_source;
  double beam_rate;  // K
  // Of order 0, where all that is scattered adds up: even weights = albedo extinction.
  double albedo = 0., lost = 1.;  // omega; 1 - omega, whose digits count near 0
};

// (S9) Their modes; none where E or O scatters more than is met, as a cut series of moments may.
std::optional<StreamModes> streamModes(const StreamSystem& system);

}  // namespace sunfleck::spp::detail
