#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "core/require.hpp"
#include "pp_solver/detail/state.hpp"

namespace sunfleck::pp {
namespace {

using detail::BasisRows;
using detail::StackRows;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double kPi = std::numbers::pi;

}  // namespace

// The ground and what arrives from outside, as hats: sqrt(w mu) times radiance.
void Solver::State::fillGround(const BasisRows& rows, StackRows& stack_rows, bool sine) {
  const int lanes = rows.lanes;
  const Ground& ground = problem.ground;
  const bool infinite = std::isinf(depth), shaped = ground.brdf && !infinite;
  stack_rows.black = infinite || !(shaped || ground.albedo > 0.);
  for (int lane = 0; lane < lanes; ++lane) {
    const int m = static_cast<int>(rows.mode[lane]);
    const bool flat_mode = m == 0 && !sine;
    const double lambert = stack_rows.black || shaped || !flat_mode ? 0. : ground.albedo;
    const double sent = !flat_mode || infinite || shaped
                            ? 0.
                            : (1. - lambert) * ground.emission + (lambert > 0. ? lambert * beamOnGround() / kPi : 0.);
    for (int i = 0; i < n; ++i) {
      const double mu = ordinates->mu()[i], hat = rows.flat[i * lanes + lane];
      stack_rows.top_in[i * lanes + lane] = 2. * hat * skyMode(problem.above, m, mu, sine);
      stack_rows.bottom_in[i * lanes + lane] =
          2. * hat * ((infinite ? 0. : skyMode(problem.below, m, mu, sine)) + sent);
    }
    if (stack_rows.black) continue;
    if (shaped) {
      fillShapedGround(rows, stack_rows, lane, sine);
      continue;
    }
    // Z = 1 - (2 A / (1 + A)) q q^T exactly, q = sqrt(2 w mu) of length 1
    const double share = lambert / (1. + lambert);
    double sum = 0.;
    for (int i = 0; i < n; ++i) sum += rows.flat[i * lanes + lane] * stack_rows.bottom_in[i * lanes + lane];
    for (int i = 0; i < n; ++i) {
      const double hat = rows.flat[i * lanes + lane];
      stack_rows.ground_row[i * lanes + lane] = -(stack_rows.bottom_in[i * lanes + lane] - 2. * share * hat * sum);
      for (int j = 0; j < n; ++j)
        stack_rows.ground_matrix[i * rows.row + j * lanes + lane] =
            (i == j ? 1. : 0.) - 4. * share * hat * rows.flat[j * lanes + lane];
    }
  }
}

// A ground of any BRDF: Z = (1 + P)^-1 (1 - P), P its reflection between the ordinates. Throws InvalidInput where the
// function is no BRDF, as far as the ordinates see it.
void Solver::State::fillShapedGround(const BasisRows& rows, StackRows& stack_rows, int lane, bool sine) {
  const int lanes = rows.lanes, m = static_cast<int>(rows.mode[lane]);
  const Ground& ground = problem.ground;
  const bool flat_mode = m == 0 && !sine, reflects = m < ground.brdf_modes;
  Vector source(n), flat(n);
  for (int i = 0; i < n; ++i) {
    flat[i] = rows.flat[i * lanes + lane];
    source[i] = 0.5 * stack_rows.bottom_in[i * lanes + lane];
  }
  Matrix reflect = Matrix::Zero(n, n);
  for (int i = 0; i < n && reflects; ++i)
    for (int j = 0; j <= i; ++j) {
      const double forth = ground.brdf(m, ordinates->mu()[i], ordinates->mu()[j]);
      const double back = ground.brdf(m, ordinates->mu()[j], ordinates->mu()[i]);
      require(std::isfinite(forth) && (m > 0 || forth >= 0.), "BRDF", forth,
              "finite, its mean over azimuth not below 0");
      require(std::abs(forth - back) <= 1e-6 * (std::abs(forth) + std::abs(back)) + 1e-12,
              "BRDF of exchanged directions", back, "the same: " + std::to_string(forth));
      reflect(i, j) = reflect(j, i) = flat[i] * flat[j] * kPi * (m == 0 ? 2. : 1.) * 0.5 * (forth + back);
    }
  if (flat_mode) {
    const Vector albedo = reflect * flat;
    for (int i = 0; i < n; ++i)
      require(albedo[i] <= flat[i] * (1. + 1e-9), "directional albedo of the ground", albedo[i] / flat[i], "at most 1");
    source += ground.emission * (flat - albedo);
  }
  if (reflects && !sine)
    for (int i = 0; i < n; ++i) {
      const double f = ground.brdf(m, ordinates->mu()[i], mu0);
      require(std::isfinite(f) && (m > 0 || f >= 0.), "BRDF", f, "finite, its mean over azimuth not below 0");
      source[i] += flat[i] * f * beamOnGround();
    }
  const Eigen::LDLT<Matrix> solve(Matrix::Identity(n, n) + reflect);
  const Matrix matrix = solve.solve(Matrix::Identity(n, n) - reflect);
  const Vector row = -2. * solve.solve(source);
  for (int i = 0; i < n; ++i) {
    stack_rows.ground_row[i * lanes + lane] = row[i];
    for (int j = 0; j < n; ++j)
      stack_rows.ground_matrix[i * rows.row + j * lanes + lane] = 0.5 * (matrix(i, j) + matrix(j, i));
  }
}

}  // namespace sunfleck::pp
