#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace sunfleck::detail {

// What is left of data once a model is taken from them, and its slopes by each parameter.
struct Residuals {
  Eigen::VectorXd values;  // [datum]
  Eigen::MatrixXd slopes;  // [datum][parameter]
};

struct BoundedFit {
  Eigen::VectorXd parameters;
  double squares = 0.;         // sum of the residuals' squares
  std::vector<char> at_bound;  // parameters that would go on where their range ends
  // Of the parameters: the diagonal of the inverse of slopes' product times the variance of a residual, over those that
  // are not at a bound; 0 of those at one, infinite where the data leave open how much is whose. As if the data's
  // errors were independent and alike.
  Eigen::VectorXd variances;
  int iterations = 0;
  bool converged = false;  // not: it took the most iterations
};

// (L7) The parameters within [low, high] of least squares, from `start` on, by Levenberg and Marquardt's method: steps
// are cut at the bounds, and a parameter at a bound takes part only where its slope leads back within. `evaluate`
// computes residuals, and slopes if it is asked for them.
BoundedFit fitWithin(const Eigen::VectorXd& start, const Eigen::VectorXd& low, const Eigen::VectorXd& high,
                     const std::function<void(const Eigen::VectorXd&, bool slopes, Residuals&)>& evaluate);

}  // namespace sunfleck::detail
