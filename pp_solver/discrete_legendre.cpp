#include "pp_solver/discrete_legendre.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

namespace sunfleck::pp {
namespace {

using Vector = std::vector<double>;

double dot(const double* a, const double* b, int n) {
  double sum = 0.;
  for (int i = 0; i < n; ++i) sum += a[i] * b[i];
  return sum;
}

// Makes `vector` orthogonal to the rows of `basis` before row `count`; twice is enough (Kahan, in Parlett 1980).
void orthogonalise(double* vector, const Vector& basis, int count, int n) {
  for (int pass = 0; pass < 2; ++pass)
    for (int j = 0; j < count; ++j) {
      const double share = dot(vector, &basis[static_cast<size_t>(j) * n], n);
      for (int i = 0; i < n; ++i) vector[i] -= share * basis[static_cast<size_t>(j) * n + i];
    }
}

double normalise(double* vector, int n) {
  const double length = std::sqrt(dot(vector, vector, n));
  for (int i = 0; i < n; ++i) vector[i] /= length;
  return length;
}

// A new direction where the one found has no length left: the node that the rows so far cover least.
void restart(double* vector, const Vector& basis, int count, int n) {
  int least = 0;
  double room = -1.;
  for (int i = 0; i < n; ++i) {
    double rest = 1.;
    for (int j = 0; j < count; ++j)
      rest -= basis[static_cast<size_t>(j) * n + i] * basis[static_cast<size_t>(j) * n + i];
    if (rest > room) {
      room = rest;
      least = i;
    }
  }
  std::fill(vector, vector + n, 0.);
  vector[least] = 1.;
  orthogonalise(vector, basis, count, n);
  normalise(vector, n);
}

DiscreteLegendre discreteLegendre(const DoubleGauss& gauss, int m) {
  const int n = static_cast<int>(gauss.mu.size());
  const size_t square = static_cast<size_t>(n) * n;
  constexpr double kNothing = 1e-13;  // a remainder shorter than this is rounding
  DiscreteLegendre basis{.n = n,
                         .mode = m,
                         .alpha = Vector(n),
                         .beta = Vector(n),
                         .even = Vector(square),
                         .odd = Vector(square),
                         .even_rise = Vector(square),
                         .odd_rise = Vector(square),
                         .up = Vector(2 * n),
                         .down = Vector(2 * n),
                         .norm = Vector(2 * n)};
  for (int i = 1; i <= m; ++i) basis.peak *= std::sqrt((2. * i - 1.) / (2. * i));
  for (int j = 0; j < 2 * n; ++j) {
    const double l = m + j, scale = std::sqrt((l + 1. - m) * (l + 1. + m));
    basis.up[j] = (2. * l + 1.) / scale;
    basis.down[j] = std::sqrt((l - m) * (l + m)) / scale;
    basis.norm[j] = std::sqrt(2. * l + 1.);
  }

  // Golub & Kahan 1965: bidiagonalises diag(mu), starting from q_m.
  for (int i = 0; i < n; ++i)
    basis.even[i] = std::sqrt(gauss.weight[i]) * std::pow((1. - gauss.mu[i]) * (1. + gauss.mu[i]), 0.5 * m);
  if (normalise(basis.even.data(), n) == 0.) restart(basis.even.data(), basis.even, 0, n);
  for (int j = 0; j < n; ++j) {
    const double* even = &basis.even[static_cast<size_t>(j) * n];
    double* odd = &basis.odd[static_cast<size_t>(j) * n];
    for (int i = 0; i < n; ++i) odd[i] = gauss.mu[i] * even[i];
    orthogonalise(odd, basis.odd, j, n);
    basis.alpha[j] = normalise(odd, n);  // > 0: mu is
    if (j + 1 == n) break;
    double* next = &basis.even[static_cast<size_t>(j + 1) * n];
    for (int i = 0; i < n; ++i) next[i] = gauss.mu[i] * odd[i];
    orthogonalise(next, basis.even, j + 1, n);
    basis.beta[j] = std::sqrt(dot(next, next, n));
    if (basis.beta[j] > kNothing) {
      for (int i = 0; i < n; ++i) next[i] /= basis.beta[j];
    } else {
      basis.beta[j] = 0.;
      restart(next, basis.even, j + 1, n);
    }
  }

  // The true functions on the nodes, and what they are in terms of q.
  Vector now(n), before(n), root(n), scaled(n);
  for (int i = 0; i < n; ++i) {
    root[i] = std::sqrt(gauss.weight[i]);
    now[i] = basis.peak * std::pow((1. - gauss.mu[i]) * (1. + gauss.mu[i]), 0.5 * m);
  }
  for (int j = 0; m + j < 2 * n; ++j) {
    for (int i = 0; i < n; ++i) scaled[i] = root[i] * basis.norm[j] * now[i];
    const Vector& q = j % 2 == 0 ? basis.even : basis.odd;
    Vector& rise = j % 2 == 0 ? basis.even_rise : basis.odd_rise;
    for (int k = 0; k <= j / 2; ++k)
      rise[static_cast<size_t>(k) * n + j / 2] = dot(&q[static_cast<size_t>(k) * n], scaled.data(), n);
    for (int i = 0; i < n; ++i) {
      const double next = basis.up[j] * gauss.mu[i] * now[i] - basis.down[j] * before[i];
      before[i] = now[i];
      now[i] = next;
    }
  }
  return basis;
}

}  // namespace

struct Ordinates::Modes {
  std::vector<std::once_flag> made;
  std::vector<DiscreteLegendre> basis;
  explicit Modes(int streams) : made(streams), basis(streams) {}
};

Ordinates::Ordinates(int streams) : gauss_(doubleGauss(streams)), modes_(std::make_unique<Modes>(streams)) {}
Ordinates::~Ordinates() = default;

const DiscreteLegendre& Ordinates::mode(int m) const {
  std::call_once(modes_->made[m], [&] { modes_->basis[m] = discreteLegendre(gauss_, m); });
  return modes_->basis[m];
}

std::shared_ptr<const Ordinates> Ordinates::of(int streams) {
  static std::mutex mutex;
  static std::map<int, std::shared_ptr<const Ordinates>> made;
  const std::lock_guard lock(mutex);
  auto& ordinates = made[streams];
  if (!ordinates) ordinates = std::make_shared<const Ordinates>(streams);
  return ordinates;
}

}  // namespace sunfleck::pp
