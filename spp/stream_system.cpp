#include "spp/detail/stream_system.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

namespace sunfleck::spp::detail {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<double> stored(const MatrixXd& matrix) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  std::vector<double> result(static_cast<std::size_t>(matrix.size()));
  Eigen::Map<Rows>(result.data(), matrix.rows(), matrix.cols()) = matrix;
  return result;
}

// k^2 = q (G - E) q of the mode that decays most slowly. Close to albedo 1 the eigenvalue's rounding would swallow it;
// here the part of the form q (G - E / albedo) q that is 0 is left out: q less its isotropic share is small there.
double slowestRateSquared(const VectorXd& q, const VectorXd& root, const MatrixXd& even, const StreamSystem& system) {
  if (system.lost == 0.) return 0.;
  const VectorXd rest = q - root * (root.dot(q) / root.squaredNorm());
  return (system.lost * q.dot(even * q) - rest.dot(even * rest)) / system.albedo +
         rest.dot(system.extinction.cwiseProduct(rest));
}

}  // namespace

// With E and O scaled by sqrt W on both sides, C C' = M^-1 (G - O) M^-1 is a Cholesky factor, the modes' k^2 are the
// eigenvalues of the symmetric C' (G - E) C, and with its vectors V:  X = W^-1/2 C V,  Y = (W^1/2 M)^-1 C'^-1 V, so
// that X' W M Y = 1.
std::optional<StreamModes> streamModes(const StreamSystem& system) {
  const VectorXd root = system.weights.cwiseSqrt(), inverse_cosines = system.cosines.cwiseInverse();
  const MatrixXd even = root.asDiagonal() * system.even * root.asDiagonal();
  const MatrixXd odd = root.asDiagonal() * system.odd * root.asDiagonal();
  const MatrixXd extinction = system.extinction.asDiagonal();

  const Eigen::LLT<MatrixXd> factor(inverse_cosines.asDiagonal() * (extinction - odd) * inverse_cosines.asDiagonal());
  const MatrixXd C = factor.matrixL();
  if (factor.info() != Eigen::Success) return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(C.transpose() * (extinction - even) * C);
  const double most = eigen.eigenvalues().cwiseAbs().maxCoeff();
  if (!(eigen.eigenvalues()[0] >= -1e-10 * most)) return std::nullopt;
  const MatrixXd& V = eigen.eigenvectors();
  const MatrixXd CV = C * V, inverse_CV = C.transpose().triangularView<Eigen::Upper>().solve(V);
  VectorXd k = eigen.eigenvalues().cwiseMax(0.).cwiseSqrt();
  if (system.albedo > 0.5) k[0] = std::sqrt(std::max(0., slowestRateSquared(CV.col(0), root, even, system)));

  const VectorXd a = inverse_CV.transpose() * inverse_cosines.cwiseProduct(root).cwiseProduct(system.odd_source);
  const VectorXd b = CV.transpose() * root.cwiseProduct(system.even_source);
  const VectorXd rates = k.array().max(1e-300).matrix() + VectorXd::Constant(k.size(), system.beam_rate);
  return StreamModes{.rate = stored(k),
                     .entering = stored((a.cwiseProduct(k) - b).cwiseQuotient(rates)),
                     .gain = stored((b + a * system.beam_rate).cwiseQuotient(rates)),
                     .sum = stored(root.cwiseInverse().asDiagonal() * CV),
                     .difference = stored(root.cwiseProduct(system.cosines).cwiseInverse().asDiagonal() * inverse_CV)};
}

}  // namespace sunfleck::spp::detail
