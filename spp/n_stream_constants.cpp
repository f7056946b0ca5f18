#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <boost/math/special_functions/legendre.hpp>
#include <cmath>
#include <numbers>

#include "core/require.hpp"
#include "spp/detail/checked_medium.hpp"
#include "spp/stream_constants.hpp"

namespace sunfleck::spp {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
constexpr double kPi = std::numbers::pi;

// 1 - x^power, exact also where x, 0 .. 1, is close to 1.
double oneMinusPower(double x, int power) {
  return x < 0.5 ? 1. - std::pow(x, power) : -std::expm1(power * std::log1p(x - 1.));
}

// Nodes and weights of Gauss and Legendre's rule on (0, 1).
struct HalfRangeGauss {
  VectorXd nodes, weights;

  explicit HalfRangeGauss(int n) : nodes(n), weights(n) {
    const std::vector<double> zeros = boost::math::legendre_p_zeros<double>(n);  // those that are not negative, rising
    for (std::size_t i = 0; i < zeros.size(); ++i) {
      const double slope = boost::math::legendre_p_prime(n, zeros[i]);
      const Index low = static_cast<Index>(zeros.size() - 1 - i), high = n - 1 - low;
      nodes[low] = 0.5 * (1. - zeros[i]);
      nodes[high] = 0.5 * (1. + zeros[i]);
      weights[low] = weights[high] = 1. / ((1. - zeros[i]) * (1. + zeros[i]) * slope * slope);
    }
  }
};

// The medium as 2 n moments can hold it: the peak |g|^2n of its phase function is set apart. Scattering within a
// forward peak counts as none; a backward peak turns diffuse light back into the opposite stream. The beam is spread by
// the backward peak as the moments have it, for turned back it would be a second beam.
struct ScaledMedium {
  double depth_scale = 1.;                    // s
  double albedo, lost;                        // omega' and 1 - omega' of the scaled medium
  double turned_back = 0.;                    // share of omega' that a backward peak holds
  std::vector<double> moments, beam_moments;  // 2 l + 1 times those of the phase function without its peak, l < 2 n

  ScaledMedium(const BeamInMedium& medium, int n) : albedo(medium.albedo), lost(1. - medium.albedo) {
    const double g = medium.asymmetry, magnitude = std::abs(g);
    double kept = 1.;  // of what is scattered, by the moments
    if (g > 0.) {
      kept = oneMinusPower(g, 2 * n);
      depth_scale = lost + albedo * kept;
      albedo *= kept / depth_scale;
      lost /= depth_scale;
    } else {
      turned_back = std::pow(g, 2 * n);
    }
    for (int l = 0; l < 2 * n; ++l) {
      const double sign = g < 0. && l % 2 == 1 ? -1. : 1.;
      const double whole = sign * (2 * l + 1) * std::pow(magnitude, l);
      moments.push_back(whole * oneMinusPower(magnitude, 2 * n - l) / kept);
      beam_moments.push_back(g > 0. ? moments.back() : whole);
    }
  }
};

std::vector<double> stored(const MatrixXd& matrix) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  std::vector<double> result(static_cast<std::size_t>(matrix.size()));
  Eigen::Map<Rows>(result.data(), matrix.rows(), matrix.cols()) = matrix;
  return result;
}

// k^2 of the mode that decays most slowly. Close to albedo 1 the eigenvalue's rounding would swallow it; here the part
// of the form q (1 - E) q that an albedo of 1 makes 0 is left out: q less its isotropic share is small there.
double slowestRateSquared(const VectorXd& q, const VectorXd& isotropic, const MatrixXd& even, double lost) {
  if (lost == 0.) return 0.;
  const VectorXd rest = q - isotropic * isotropic.dot(q);
  return lost * q.dot(even * q) + rest.squaredNorm() - rest.dot(even * rest);
}

// With W the weights and M the cosines of the streams, E and O the even and odd moments of the scattering between them
// (scaled by sqrt W on both sides), C C' = (1 - O) / (M M') is a Cholesky factor, the modes' k^2 are the eigenvalues
// of the symmetric C' (1 - E) C, and with its vectors V:  X = W^-1/2 C V,  Y = (W^1/2 M)^-1 C'^-1 V.
StreamModes streamModes(const BeamInMedium& medium, const ScaledMedium& scaled, const HalfRangeGauss& gauss,
                        int order) {
  const Index n = gauss.nodes.size(), rows = 2 * n - order;
  const VectorXd root = gauss.weights.cwiseSqrt(), inverse_cosines = gauss.nodes.cwiseInverse();

  MatrixXd even_terms = MatrixXd::Zero(rows, n), odd_terms = even_terms;  // sqrt W Legendre functions at the nodes
  MatrixXd even_functions = even_terms, odd_functions = even_terms;
  VectorXd at_beam(rows), moments(rows), beam_moments(rows), true_moments(rows), column(rows);
  legendreFunctions(order, medium.mu0, {at_beam.data(), static_cast<std::size_t>(rows)});
  for (Index r = 0; r < rows; ++r) {
    moments[r] = scaled.moments[static_cast<std::size_t>(r + order)];
    beam_moments[r] = scaled.beam_moments[static_cast<std::size_t>(r + order)];
    true_moments[r] =
        static_cast<double>(2 * (r + order) + 1) * std::pow(medium.asymmetry, static_cast<int>(r + order));
  }
  for (Index i = 0; i < n; ++i) {
    legendreFunctions(order, gauss.nodes[i], {column.data(), static_cast<std::size_t>(rows)});
    for (Index r = 0; r < rows; ++r) (r % 2 == 0 ? even_functions : odd_functions)(r, i) = column[r];
  }
  even_terms = even_functions * root.asDiagonal();
  odd_terms = odd_functions * root.asDiagonal();
  const MatrixXd identity = MatrixXd::Identity(n, n);
  const MatrixXd back = (order % 2 == 0 ? scaled.turned_back : -scaled.turned_back) * identity;
  const MatrixXd even = even_terms.transpose() * moments.asDiagonal() * even_terms + back;  // E over omega'
  const MatrixXd odd = odd_terms.transpose() * moments.asDiagonal() * odd_terms - back;

  const MatrixXd C = MatrixXd(
      (inverse_cosines.asDiagonal() * (identity - scaled.albedo * odd) * inverse_cosines.asDiagonal()).llt().matrixL());
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(C.transpose() * (identity - scaled.albedo * even) * C);
  const MatrixXd V = eigen.eigenvectors();
  const MatrixXd CV = C * V, inverse_CV = C.transpose().triangularView<Eigen::Upper>().solve(V);
  VectorXd k = eigen.eigenvalues().cwiseMax(0.).cwiseSqrt();
  if (order == 0) k[0] = std::sqrt(std::max(0., slowestRateSquared(CV.col(0), root, even, scaled.lost)));

  const double doubled = order == 0 ? 1. : 2.;
  const VectorXd source = doubled * scaled.albedo / (2. * kPi) * beam_moments.cwiseProduct(at_beam);
  const VectorXd even_source = even_functions.transpose() * source, odd_source = odd_functions.transpose() * source;
  const VectorXd a = inverse_CV.transpose() * (inverse_cosines.cwiseProduct(root).cwiseProduct(odd_source));
  const VectorXd b = CV.transpose() * root.cwiseProduct(even_source);
  const VectorXd g = (b * medium.mu0 + a).cwiseQuotient(VectorXd::Ones(n) + k * medium.mu0);

  const MatrixXd X = root.cwiseInverse().asDiagonal() * CV;
  const MatrixXd Y = root.cwiseProduct(gauss.nodes).cwiseInverse().asDiagonal() * inverse_CV;
  const MatrixXd weighted_X = gauss.weights.asDiagonal() * X, weighted_Y = gauss.weights.asDiagonal() * Y;
  const MatrixXd seen =
      0.5 * medium.albedo * true_moments.asDiagonal() * (even_functions * weighted_X + odd_functions * weighted_Y);
  return {.rate = stored(k),
          .odd_source = stored(a),
          .gain = stored(g),
          .sum = stored(X),
          .difference = stored(Y),
          .seen = stored(seen)};
}

}  // namespace

void legendreFunctions(int order, double mu, std::span<double> result) {
  const int m = order, rows = static_cast<int>(result.size());
  double last = 0., value = 1.;
  const double sine = std::sqrt(std::max(0., (1. - mu) * (1. + mu)));
  for (int i = 1; i <= m; ++i) value *= sine * std::sqrt((2. * i - 1.) / (2. * i));
  for (int r = 0; r < rows; ++r) {
    result[static_cast<std::size_t>(r)] = value;
    const int l = m + r;
    const double next = ((2. * l + 1.) * mu * value - std::sqrt(double((l - m) * (l + m))) * last) /
                        std::sqrt(double((l + 1 - m) * (l + 1 + m)));
    last = value;
    value = next;
  }
}

StreamConstants nStreamConstants(const BeamInMedium& medium, int streams, int azimuth_orders) {
  require(streams >= 1 && streams <= kMostStreams, "streams", streams, "from 1 to 32");
  require(azimuth_orders >= 1 && azimuth_orders <= 2 * streams, "azimuth orders", azimuth_orders,
          "from 1 to twice the streams");
  const BeamInMedium checked = detail::checkedMedium(medium);
  const ScaledMedium scaled(checked, streams);
  const HalfRangeGauss gauss(streams);
  StreamConstants constants{.medium = checked, .depth_scale = scaled.depth_scale};
  for (Index i = 0; i < gauss.nodes.size(); ++i) {
    constants.cosines.push_back(gauss.nodes[i]);
    constants.solid_angles.push_back(2. * kPi * gauss.weights[i]);
  }
  for (int m = 0; m < azimuth_orders; ++m) constants.orders.push_back(streamModes(checked, scaled, gauss, m));
  return constants;
}

}  // namespace sunfleck::spp
