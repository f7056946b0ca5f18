#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "pp_solver/discrete_legendre.hpp"

// What the solver's kernel reads and writes. All numbers lie in rows; several problems (or azimuth modes) may be
// interleaved: number x of lane l stands at [x * lanes + l]. A row of n numbers is padded to whole vectors.
namespace sunfleck::pp::detail {

// Memory for rows, aligned for the widest vectors; it is kept and given out anew by clear().
class RowMemory {
 public:
  double* take(std::size_t count);  // zeros
  void clear() { block_ = used_ = 0; }

 private:
  struct Free {
    void operator()(double* p) const;
  };
  struct Block {
    std::unique_ptr<double[], Free> numbers;
    std::size_t size;
  };
  std::vector<Block> blocks_;
  std::size_t block_ = 0, used_ = 0;
};

// DiscreteLegendre of `lanes` azimuth modes (first_mode + lane), or of one mode in all lanes, as rows.
struct BasisRows {
  int n = 0, lanes = 1;
  std::size_t row = 0;           // numbers in a row of n, padding included
  double *alpha, *beta;          // [n]
  double *even, *odd;            // n rows over the nodes
  double *even_rise, *odd_rise;  // n rows over the order
  double *up, *down, *norm;      // [2 n]
  double *peak, *mode;           // one for each lane
  double *flat, *mu_root;        // rows over the nodes: sqrt(w mu), sqrt(mu)
  RowMemory memory;
  BasisRows(const Ordinates& ordinates, int first_mode, bool successive, int vector_lanes, bool wide);
};

// A layer as the kernel has it. Depth is counted from the layer's top, in scaled units; hats are node values times
// sqrt(w mu).
struct LayerRows {
  // Given
  double* scatter;    // [2 n] omega chi_l, l = m + j
  double* loss;       // [2 n] 1 - scatter, exact where that is small
  double* thickness;  // [1 per lane]
  double* rate;       // kappa = G(mu0) / mu0 of the beam [1 per lane]
  double *even_source,
      *odd_source;  // rows in the basis: the beam's source J+ + J- and J+ - J-, times sqrt(w), at the top
  double *planck_top, *planck_bottom;  // B at both ends [1 per lane]
  double* drift;                       // hat of h, what dB/dz turns downward (P14): row over the nodes
  bool infinite = false;
  bool given_modes = false;  // k2, x, y are given, in node space

  // Eigenmodes j: S = sum x_j u_j, D = sum y_j v_j, u' = -v, v' = -k^2 u without sources
  double *k, *k2;             // rows over j
  double *x, *y;              // n rows over the basis
  double *x_hat, *y_hat;      // n rows over the nodes
  double *x_flux, *y_flux;    // rows over j: flat . x_hat, flat . y_hat
  double *x_mean, *x_absorb;  // rows over j: sum of w S; of w G S
  // Particular solution of the beam: u = g D(k, kappa, z), v = (a - g) e^-kappa z + g k D
  double *a, *g;
  double *s, *t, *through;                      // tanh(k w / 2) / k, k tanh(k w / 2), e^-kw: rows over j
  double *u_top, *u_bottom, *v_top, *v_bottom;  // homogeneous part at the ends: rows over j
  // Only where layers are stacked: for the way down
  double *factor, *factor_inverse, *remainder;
  double* ends;  // the particular solution, four rows: S, D at the top, S, D at the bottom
};

struct StackRows {
  int n = 0, lanes = 0, layers = 0;
  LayerRows* layer = nullptr;  // no std::vector: code of an instruction set must not share the library's templates
  double* top_in;              // 2 sqrt(w mu) I+ that arrives at the top: row over the nodes
  double* bottom_in;           // 2 sqrt(w mu) I- that leaves the ground by itself, for a black ground
  bool black = true;
  double *ground_matrix = nullptr, *ground_row = nullptr;  // else d_hat = matrix s_hat + row at the bottom
  double *s_top = nullptr, *d_top = nullptr, *s_bottom = nullptr,
         *d_bottom = nullptr;  // hats of S and D at the ends of the stack, rows over the nodes
  double *admittance = nullptr,
         *offset = nullptr;   // d_hat = matrix s_hat + row at the top of each layer, and of the ground
  double* scratch = nullptr;  // 4 n + 12 rows
  RowMemory memory;
  std::vector<LayerRows> layers_held;
};

}  // namespace sunfleck::pp::detail
