#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <vector>

#include "pp_solver/detail/state.hpp"

namespace sunfleck::pp {
namespace {

using detail::BasisRows;
using detail::LayerRows;

// The transfer equation of one layer and azimuth mode at the ordinates, made from scratch: extinction, scattering
// matrices of S and D, and the beam's source.
struct NodeEquation {
  int n;
  std::vector<double> extinction, even, odd;  // G; E and O [i * n + j], weights of node j included
  std::vector<double> beam_down, beam_up;     // source at the layer's top
  double rate = 0., loss = 1.;
};

NodeEquation nodeEquation(const Solver::State& s, const BasisRows& rows, const LayerRows& row, std::size_t p) {
  const int n = s.n, m = static_cast<int>(rows.mode[0]);
  const auto& weight = s.ordinates->weight();
  NodeEquation equation{.n = n,
                        .extinction = std::vector<double>(n, 1.),
                        .even = std::vector<double>(static_cast<std::size_t>(n) * n),
                        .odd = std::vector<double>(static_cast<std::size_t>(n) * n),
                        .beam_down = std::vector<double>(n),
                        .beam_up = std::vector<double>(n),
                        .rate = row.rate[0],
                        .loss = s.layers[p].loss};
  if (row.given_modes && !s.layers[p].leaves) {
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        double &even = equation.even[i * n + j], &odd = equation.odd[i * n + j];
        s.directionKernel(rows, 0, p, s.ordinates->mu()[i], s.ordinates->mu()[j], even, odd);
        even *= weight[j];
        odd *= weight[j];
      }
  } else if (s.layers[p].leaves) {
    const auto& leaves = std::get<LeafScattering>(s.problem.layers[p].medium);
    s.tables[p]->betweenNodes(m).evenOdd(leaves.reflectance, leaves.transmittance, equation.even, equation.odd);
    for (int i = 0; i < n; ++i) {
      equation.extinction[i] = s.tables[p]->nodes().projection(i);
      for (int j = 0; j < n; ++j) {
        equation.even[i * n + j] *= weight[j];
        equation.odd[i * n + j] *= weight[j];
      }
    }
  } else {
    const DiscreteLegendre& basis = s.ordinates->mode(m);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double scale = std::sqrt(weight[j] / weight[i]);
        for (int l = 0; l < n; ++l) {
          equation.even[i * n + j] += scale * row.scatter[2 * l] * basis.even[l * n + i] * basis.even[l * n + j];
          equation.odd[i * n + j] += scale * row.scatter[2 * l + 1] * basis.odd[l * n + i] * basis.odd[l * n + j];
        }
      }
  }
  for (int i = 0; i < n && s.beam > 0.; ++i) {
    if (s.layers[p].leaves) {
      const double root = std::sqrt(weight[i]);
      equation.beam_down[i] = 0.5 * (row.even_source[i] + row.odd_source[i]) / root;
      equation.beam_up[i] = 0.5 * (row.even_source[i] - row.odd_source[i]) / root;
    } else {
      s.beamSource(rows, 0, p, s.ordinates->mu()[i], equation.beam_down[i], equation.beam_up[i]);
    }
  }
  return equation;
}

}  // namespace

double Solver::residual(int modes) {
  State& s = solved();
  const int n = s.n;
  const auto& mu = s.ordinates->mu();
  using Gauss = boost::math::quadrature::gauss<double, 10>;
  double worst = 0., largest = 0.;
  std::vector<double> down(n), up(n), source_down(n), source_up(n);
  for (int m = 0; m < std::min(modes, s.settings.streams); ++m) {
    const BasisRows rows(*s.ordinates, m, true, s.kernel.lanes, false);
    detail::StackRows stack;
    s.solveBundle(rows, stack, false);
    for (std::size_t p = 0; p < s.layers.size(); ++p) {
      const LayerRows& row = stack.layer[p];
      const NodeEquation equation = nodeEquation(s, rows, row, p);
      const double thickness = s.layers[p].thickness;
      // Radiance at the nodes at depth z, and the source there
      const auto field = [&](double z) {
        s.kernel.single.fieldAt(rows, row, &z, s.u_row, s.v_row);
        const double share = std::isinf(thickness) ? 0. : z / thickness;
        const double planck = row.planck_top[0] + share * (row.planck_bottom[0] - row.planck_top[0]);
        for (int i = 0; i < n; ++i) {
          double sum = 0., difference = 0.;
          for (int j = 0; j < n; ++j) {
            sum += row.x_hat[j * rows.row + i] * s.u_row[j];
            difference += row.y_hat[j * rows.row + i] * s.v_row[j];
          }
          sum = sum / rows.flat[i] + 2. * planck;
          difference = (difference + 2. * row.drift[i]) / rows.flat[i];
          down[i] = 0.5 * (sum + difference);
          up[i] = 0.5 * (sum - difference);
        }
        const double beam = std::exp(-equation.rate * z);
        for (int i = 0; i < n; ++i) {
          double even = 0., odd = 0.;
          for (int j = 0; j < n; ++j) {
            even += equation.even[i * n + j] * (down[j] + up[j]);
            odd += equation.odd[i * n + j] * (down[j] - up[j]);
          }
          const double emitted = equation.loss * equation.extinction[i] * planck;
          source_down[i] = 0.5 * (even + odd) + equation.beam_down[i] * beam + emitted;
          source_up[i] = 0.5 * (even - odd) + equation.beam_up[i] * beam + emitted;
        }
      };
      // Over a step in which nothing decays much, the equation integrated: exact for the ordinates, by Gauss's rule for
      // the source.
      const double step = std::min(0.25 * mu[0], 0.5 * thickness);
      const double end = std::isinf(thickness) ? 20. : thickness;
      for (const double place : {0., 1e-3, 0.03, 0.2, 0.5, 0.8, 0.97, 0.999, 1.}) {
        const double from = place * (end - step);
        std::vector<double> top_down(n), bottom_up(n), add_down(n, 0.), add_up(n, 0.);
        field(from);
        top_down = down;
        const std::vector<double> top_up = up;
        field(from + step);
        bottom_up = up;
        const std::vector<double> bottom_down = down;
        for (std::size_t q = 0; q < Gauss::abscissa().size(); ++q)
          for (const double side : {-1., 1.}) {
            const double z = 0.5 * step * (1. + side * Gauss::abscissa()[q]);
            field(from + z);
            for (int i = 0; i < n; ++i) {
              const double rate = equation.extinction[i] / mu[i], weight = 0.5 * step * Gauss::weights()[q] / mu[i];
              add_down[i] += weight * source_down[i] * std::exp(-rate * (step - z));
              add_up[i] += weight * source_up[i] * std::exp(-rate * z);
            }
          }
        for (int i = 0; i < n; ++i) {
          const double rate = equation.extinction[i] / mu[i], kept = std::exp(-rate * step);
          const double passed = std::max(-std::expm1(-rate * step), 1e-3);
          largest = std::max({largest, std::abs(top_down[i]), std::abs(bottom_up[i]), std::abs(source_down[i]),
                              std::abs(source_up[i])});
          worst = std::max({worst, std::abs(bottom_down[i] - kept * top_down[i] - add_down[i]) / passed,
                            std::abs(top_up[i] - kept * bottom_up[i] - add_up[i]) / passed});
        }
      }
    }
  }
  return largest > 0. ? worst / largest : 0.;
}

}  // namespace sunfleck::pp
