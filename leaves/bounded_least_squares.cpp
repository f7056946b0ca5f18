#include "leaves/detail/bounded_least_squares.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

namespace sunfleck::detail {
namespace {

constexpr int kMostIterations = 500;
constexpr double kSmallestGain = 1e-14;  // of the squares, at which the method has arrived
constexpr double kMostDamping = 1e16;    // at which a step is within rounding

// Parameters that may move: not those at a bound whose slope leads beyond.
std::vector<Eigen::Index> freeOf(const Eigen::VectorXd& x, const Eigen::VectorXd& low, const Eigen::VectorXd& high,
                                 const Eigen::VectorXd& gradient) {
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < x.size(); ++i)
    if (!(x[i] <= low[i] && gradient[i] >= 0.) && !(x[i] >= high[i] && gradient[i] <= 0.)) free.push_back(i);
  return free;
}

// The diagonal of (J^T J)^-1; infinite for parameters that share in a direction in which J is 0 but for rounding.
Eigen::VectorXd inverseDiagonal(const Eigen::MatrixXd& slopes) {
  constexpr double kRounding = 1e-12;  // of slopes' products, of length 1
  const Eigen::VectorXd lengths = slopes.colwise().norm();
  const Eigen::MatrixXd alike = slopes * lengths.cwiseMax(1e-300).cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(alike.transpose() * alike);
  Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(lengths.size());
  for (Eigen::Index mode = 0; mode < lengths.size(); ++mode)
    for (Eigen::Index i = 0; i < lengths.size(); ++i) {
      const double share = std::pow(modes.eigenvectors()(i, mode), 2), length = modes.eigenvalues()[mode];
      if (length > kRounding)
        diagonal[i] += share / (length * lengths[i] * lengths[i]);
      else if (share > 1e-6)
        diagonal[i] = std::numeric_limits<double>::infinity();
    }
  return diagonal;
}

}  // namespace

BoundedFit fitWithin(const Eigen::VectorXd& start, const Eigen::VectorXd& low, const Eigen::VectorXd& high,
                     const std::function<void(const Eigen::VectorXd&, bool, Residuals&)>& evaluate) {
  BoundedFit fit;
  fit.parameters = start.cwiseMax(low).cwiseMin(high);
  Residuals now, then;
  evaluate(fit.parameters, true, now);
  fit.squares = now.values.squaredNorm();
  double damping = 1e-3;
  std::vector<Eigen::Index> free;
  for (; fit.iterations < kMostIterations && !fit.converged; ++fit.iterations) {
    const Eigen::VectorXd gradient = now.slopes.transpose() * now.values;
    free = freeOf(fit.parameters, low, high, gradient);
    const Eigen::MatrixXd slopes = now.slopes(Eigen::all, free);
    const Eigen::MatrixXd product = slopes.transpose() * slopes;
    Eigen::MatrixXd damped = product;
    damped.diagonal() *= 1. + damping;
    const Eigen::VectorXd step = damped.ldlt().solve(-gradient(free));
    Eigen::VectorXd next = fit.parameters;
    next(free) += step;
    next = next.cwiseMax(low).cwiseMin(high);
    evaluate(next, false, then);
    const double squares = then.values.squaredNorm();
    if (squares < fit.squares) {
      fit.converged = fit.squares - squares <= kSmallestGain * fit.squares;
      fit.parameters = next;
      fit.squares = squares;
      evaluate(fit.parameters, true, now);
      damping = std::max(0.1 * damping, 1e-12);
    } else {
      damping *= 10.;
      fit.converged = free.empty() || damping > kMostDamping;
    }
  }
  free = freeOf(fit.parameters, low, high, now.slopes.transpose() * now.values);
  fit.at_bound.assign(static_cast<std::size_t>(start.size()), true);
  for (const Eigen::Index i : free) fit.at_bound[static_cast<std::size_t>(i)] = false;
  fit.variances = Eigen::VectorXd::Zero(start.size());
  if (!free.empty()) {
    const auto more = static_cast<double>(now.values.size() - static_cast<Eigen::Index>(free.size()));
    fit.variances(free) = inverseDiagonal(now.slopes(Eigen::all, free)) * (more > 0. ? fit.squares / more : 1.);
  }
  return fit;
}

}  // namespace sunfleck::detail
