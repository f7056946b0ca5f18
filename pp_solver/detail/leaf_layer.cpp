#include "pp_solver/detail/leaf_layer.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace sunfleck::pp::detail {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double kAnyDirection[] = {1.};

}  // namespace

LeafTables::LeafTables(const LeafAngles& angles, const std::vector<double>& mu, const std::vector<double>& weight)
    : nodes_(angles, mu, weight), beam_(angles, kAnyDirection), views_(angles, kAnyDirection) {}

void LeafTables::setBeam(double mu0) {
  if (beam_.mu(0) != mu0) beam_ = LeafProjections(angles(), std::span(&mu0, 1));
}

void LeafTables::setViews(std::span<const double> cosines) {
  bool same = views_.size() == cosines.size();
  for (std::size_t i = 0; same && i < cosines.size(); ++i) same = views_.mu(i) == cosines[i];
  if (!same) views_ = LeafProjections(angles(), cosines);
}

std::size_t LeafTables::viewAt(double mu) const {
  std::size_t i = 0;
  while (views_.mu(i) != mu) ++i;
  return i;
}

void LeafTables::setMode(int mode) {
  nodes_.setMode(mode);
  beam_.setMode(mode);
  views_.setMode(mode);
}

const LeafKernel& LeafTables::betweenNodes(int mode) {
  const auto found = between_nodes_.find(mode);
  if (found != between_nodes_.end()) return found->second;
  setMode(mode);
  LeafKernel& kernel = between_nodes_[mode];
  fillLeafKernel(nodes_, nodes_, kernel);
  return kernel;
}

const LeafKernel& LeafTables::fromBeam(int mode) {
  setMode(mode);
  fillLeafKernel(nodes_, beam_, from_beam_);
  return from_beam_;
}

const LeafKernel& LeafTables::intoViews(int mode) {
  setMode(mode);
  fillLeafKernel(views_, nodes_, into_views_);
  return into_views_;
}

const LeafKernel& LeafTables::beamIntoViews(int mode) {
  setMode(mode);
  fillLeafKernel(views_, beam_, beam_into_views_);
  return beam_into_views_;
}

void leafModes(const BasisRows& basis, LayerRows& row, LeafTables& tables, const LeafScattering& leaves,
               const std::vector<double>& weight) {
  const int n = basis.n, mode = static_cast<int>(basis.mode[0]);
  const double omega = leaves.reflectance + leaves.transmittance;
  const LeafKernel& kernel = tables.betweenNodes(mode);
  std::vector<double> even(kernel.modulus.size()), odd(kernel.modulus.size());
  // Of the even part in mode 0, omega is put on later: it cancels with the extinction
  kernel.evenOdd(leaves.reflectance, leaves.transmittance, even, odd);
  Matrix a(n, n), b(n, n), extinction = Matrix::Zero(n, n);
  Vector constant(n);
  for (int i = 0; i < n; ++i) {
    const double g = tables.nodes().projection(i), mu_i = basis.mu_root[i];
    constant[i] = basis.flat[i];
    extinction(i, i) = g / (mu_i * mu_i);
    for (int j = 0; j < n; ++j) {
      const double scale = std::sqrt(weight[i] * weight[j]) / (mu_i * basis.mu_root[j]);
      const double e = mode == 0 ? kernel.modulus[i * n + j] : even[i * n + j];
      a(i, j) = -scale * e;
      b(i, j) = -scale * odd[i * n + j];
    }
    a(i, i) += extinction(i, i);
    b(i, i) += extinction(i, i);
  }
  a = 0.5 * (a + a.transpose()).eval();
  b = 0.5 * (b + b.transpose()).eval();
  const Eigen::LLT<Matrix> factor(b);
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
    c = omega * c + (1. - omega) * absorbing;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix> modes(c);
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
      density += root * tables.nodes().projection(i) * xi;
      flow += root * basis.mu_root[i] * basis.mu_root[i] * yi;
    }
    row.x_absorb[j] = density;
    // What a slow mode loses is what is absorbed: k^2 without cancellation.
    if (mode == 0 && j == 0) k2 = omega == 1. ? 0. : (1. - omega) * density / flow;
    row.k2[j] = std::max(k2, 0.);
    row.k[j] = std::sqrt(row.k2[j]);
  }
}

}  // namespace sunfleck::pp::detail
