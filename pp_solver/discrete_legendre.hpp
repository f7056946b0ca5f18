#pragma once

#include <memory>
#include <vector>

#include "scattering/double_gauss.hpp"

// Angles and polynomials of discrete ordinates: all that depends on the number of streams and the azimuth mode alone.
namespace sunfleck::pp {

// (P2) Legendre functions made orthonormal on the ordinates themselves, for one azimuth mode m.
//
// On the nodes, sqrt(w_i (2 l + 1)) Lambda_l^m(mu_i) is orthonormal only as far as double Gauss integrates exactly.
// q_l is what Gram and Schmidt make of it, in the order of l. The ordinates see a phase function as sum chi_l q_l q_l^T
// (Galerkin quadrature, Morel 1989): an operator whose eigenvalues are chi_l, so that the solution is stable for every
// phase function and number of streams. Multiplication by mu takes q_l to its two neighbours; between the functions
// even and odd in mu it is bidiagonal,
//     mu q_odd[j] = alpha[j] q_even[j] + beta[j] q_even[j + 1],
// and the eigenproblem of a layer becomes the singular values of a bidiagonal matrix.
//
// Here even[j] has l = m + 2 j, odd[j] has l = m + 2 j + 1; n = N / 2 of each, those with l >= N only to fill the
// space.
struct DiscreteLegendre {
  int n = 0, mode = 0;
  std::vector<double> alpha, beta;  // n each; beta[n - 1] = 0
  std::vector<double> even, odd;    // q [j * n + i] at node i, sqrt(w_i) included
  // What the true functions are in terms of q: v_l = sum over l' of rise[l'][l] q_l', l' <= l, by parity [j' * n + j].
  std::vector<double> even_rise, odd_rise;
  // Recurrence of the true functions: Lambda_{l+1} = (up[j] mu Lambda_l - down[j] Lambda_{l-1}), l = m + j, and
  // norm[j] = sqrt(2 l + 1); 2 n of each.
  std::vector<double> up, down, norm;
  // Lambda_m^m(mu) = peak (1 - mu^2)^(m / 2)
  double peak = 1.;
};

// Shared by all solvers of so many streams; modes are made when first asked for. Safe to call from several threads.
class Ordinates {
 public:
  static std::shared_ptr<const Ordinates> of(int streams);
  ~Ordinates();

  int streams() const { return 2 * static_cast<int>(gauss_.mu.size()); }
  const std::vector<double>& mu() const { return gauss_.mu; }
  const std::vector<double>& weight() const { return gauss_.weight; }
  const DiscreteLegendre& mode(int m) const;

  explicit Ordinates(int streams);

 private:
  struct Modes;
  DoubleGauss gauss_;
  std::unique_ptr<Modes> modes_;
};

}  // namespace sunfleck::pp
