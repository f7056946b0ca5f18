#include "pp_solver/detail/dense_modes.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/require.hpp"

namespace sunfleck::pp::detail {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

}  // namespace

void denseModes(const BasisRows& basis, LayerRows& row, const DenseMedium& medium, const std::vector<double>& weight) {
  const int n = basis.n, mode = static_cast<int>(basis.mode[0]);
  Matrix a(n, n), b(n, n), extinction = Matrix::Zero(n, n);
  Vector constant(n);
  for (int i = 0; i < n; ++i) {
    const double g = medium.extinction[i], mu_i = basis.mu_root[i];
    constant[i] = basis.flat[i];
    extinction(i, i) = g / (mu_i * mu_i);
    for (int j = 0; j < n; ++j) {
      const double scale = std::sqrt(weight[i] * weight[j]) / (mu_i * basis.mu_root[j]);
      a(i, j) = -scale * medium.even[i * n + j];
      b(i, j) = -scale * medium.odd[i * n + j];
    }
    a(i, i) += extinction(i, i);
    b(i, i) += extinction(i, i);
  }
  a = 0.5 * (a + a.transpose()).eval();
  b = 0.5 * (b + b.transpose()).eval();
  const Eigen::LLT<Matrix> factor(b);
  require(factor.info() == Eigen::Success, "streams", 2 * n,
          "more, or without collocation: they do not carry this phase function");
  const Vector drift = factor.solve(constant);
  for (int i = 0; i < n; ++i) row.drift[i] = -medium.planck_slope * drift[i];
  const Matrix lower = factor.matrixL();
  Matrix c = lower.transpose() * a * lower;
  Matrix turned = Matrix::Identity(n, n);
  if (mode == 0) {
    // a = (1 - omega) G + omega (G - K), and the second part takes the constant to exactly 0: a reflection that turns
    // the constant onto the last axis lets its row be set to that.
    Vector axis = lower.triangularView<Eigen::Lower>().solve(constant);
    axis.normalize();
    Vector mirror = axis;
    mirror[n - 1] += axis[n - 1] < 0. ? -1. : 1.;
    mirror.normalize();
    turned -= 2. * mirror * mirror.transpose();
    c = (turned * c * turned).eval();
    c.row(n - 1).setZero();
    c.col(n - 1).setZero();
    const Matrix absorbing = turned * (lower.transpose() * extinction * lower) * turned;
    c = medium.albedo * c + medium.loss * absorbing;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix> modes(c);
  // Rounding of the largest eigenvalue is 1e-16 of it; a negative one beyond that lets light grow without bound.
  require(modes.eigenvalues()[0] >= -1e-12 * modes.eigenvalues()[n - 1], "streams", 2 * n,
          "more, or without collocation: they do not carry this phase function");
  const Matrix vectors = turned * modes.eigenvectors();
  const Matrix x = lower * vectors, y = lower.transpose().triangularView<Eigen::Upper>().solve(vectors);
  for (int j = 0; j < n; ++j) {
    double k2 = modes.eigenvalues()[j], density = 0., flow = 0.;
    row.x_mean[j] = row.x_absorb[j] = 0.;
    for (int i = 0; i < n; ++i) {
      const double xi = x(i, j) / basis.mu_root[i], yi = y(i, j) / basis.mu_root[i], root = std::sqrt(weight[i]);
      row.x[j * basis.row + i] = xi;
      row.y[j * basis.row + i] = yi;
      row.x_mean[j] += root * xi;
      density += root * medium.extinction[i] * xi;
      flow += root * basis.mu_root[i] * basis.mu_root[i] * yi;
    }
    row.x_absorb[j] = density;
    // What a slow mode loses is what is absorbed: k^2 without cancellation.
    if (mode == 0 && j == 0) k2 = medium.loss == 0. ? 0. : medium.loss * density / flow;
    row.k2[j] = std::max(k2, 0.);
    row.k[j] = std::sqrt(row.k2[j]);
  }
}

}  // namespace sunfleck::pp::detail
