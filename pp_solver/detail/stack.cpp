#include "pp_solver/detail/stack.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <new>

#include "pp_solver/detail/kernel.hpp"

namespace sunfleck::pp::detail {
namespace {

constexpr std::size_t kAlignment = 64, kGrain = kAlignment / sizeof(double);

std::size_t roundUp(std::size_t count, std::size_t grain) {
  return (count + grain - 1) / grain * grain;
}

}  // namespace

void RowMemory::Free::operator()(double* p) const {
  std::free(p);
}

double* RowMemory::take(std::size_t count) {
  count = roundUp(std::max<std::size_t>(count, 1), kGrain);
  while (block_ < blocks_.size() && used_ + count > blocks_[block_].size) {
    ++block_;
    used_ = 0;
  }
  if (block_ == blocks_.size()) {
    const std::size_t size = std::max<std::size_t>(count, 1 << 14);
    auto* numbers = static_cast<double*>(std::aligned_alloc(kAlignment, size * sizeof(double)));
    if (numbers == nullptr) throw std::bad_alloc();
    blocks_.push_back({std::unique_ptr<double[], Free>(numbers), size});
  }
  double* taken = blocks_[block_].numbers.get() + used_;
  used_ += count;
  std::fill(taken, taken + count, 0.);
  return taken;
}

BasisRows::BasisRows(const Ordinates& ordinates, int first_mode, bool successive, int vector_lanes, bool wide) {
  n = ordinates.streams() / 2;
  lanes = wide ? vector_lanes : 1;
  row = wide ? static_cast<std::size_t>(n > 8 ? n | 1 : n) * lanes : roundUp(n, vector_lanes);  // see rowWidth
  const auto count = static_cast<std::size_t>(n);
  alpha = memory.take(count * lanes);
  beta = memory.take(count * lanes);
  even = memory.take(count * row);
  odd = memory.take(count * row);
  even_rise = memory.take(count * row);
  odd_rise = memory.take(count * row);
  up = memory.take(2 * count * lanes);
  down = memory.take(2 * count * lanes);
  norm = memory.take(2 * count * lanes);
  peak = memory.take(lanes);
  mode = memory.take(lanes);
  flat = memory.take(row);
  mu_root = memory.take(row);
  for (int lane = 0; lane < lanes; ++lane) {
    // Modes beyond the last have no light; any that exists stands in.
    const int m = std::min(first_mode + (successive ? lane : 0), ordinates.streams() - 1);
    const DiscreteLegendre& basis = ordinates.mode(m);
    peak[lane] = basis.peak;
    mode[lane] = first_mode + (successive ? lane : 0);
    for (int i = 0; i < n; ++i) {
      const double mu = ordinates.mu()[i], weight = ordinates.weight()[i];
      alpha[i * lanes + lane] = basis.alpha[i];
      beta[i * lanes + lane] = basis.beta[i];
      flat[i * lanes + lane] = std::sqrt(weight * mu);
      mu_root[i * lanes + lane] = std::sqrt(mu);
      for (int j = 0; j < n; ++j) {
        const std::size_t from = static_cast<std::size_t>(i) * n + j, to = i * row + j * lanes + lane;
        even[to] = basis.even[from];
        odd[to] = basis.odd[from];
        even_rise[to] = basis.even_rise[from];
        odd_rise[to] = basis.odd_rise[from];
      }
    }
    for (int j = 0; j < 2 * n; ++j) {
      up[j * lanes + lane] = basis.up[j];
      down[j * lanes + lane] = basis.down[j];
      norm[j * lanes + lane] = basis.norm[j];
    }
  }
}

void shape(StackRows& stack, const BasisRows& basis, int layers) {
  if (stack.n == basis.n && stack.lanes == basis.lanes && stack.layers == layers) return;
  stack.n = basis.n;
  stack.lanes = basis.lanes;
  stack.layers = layers;
  stack.memory.clear();
  stack.layers_held.resize(layers);
  stack.layer = stack.layers_held.data();
  const std::size_t n = basis.n, row = basis.row, square = n * row, lanes = basis.lanes;
  const auto take = [&](std::size_t count) { return stack.memory.take(count); };
  for (LayerRows& layer : stack.layers_held) {
    layer = {};
    for (double** p : {&layer.scatter, &layer.loss}) *p = take(2 * n * lanes);
    for (double** p : {&layer.thickness, &layer.rate, &layer.planck_top, &layer.planck_bottom}) *p = take(lanes);
    for (double** p : {&layer.x, &layer.y, &layer.x_hat, &layer.y_hat, &layer.factor}) *p = take(square);
    for (double** p : {&layer.drift,
                       &layer.even_source,
                       &layer.odd_source,
                       &layer.k,
                       &layer.k2,
                       &layer.x_flux,
                       &layer.y_flux,
                       &layer.x_mean,
                       &layer.x_absorb,
                       &layer.a,
                       &layer.g,
                       &layer.s,
                       &layer.t,
                       &layer.through,
                       &layer.u_top,
                       &layer.u_bottom,
                       &layer.v_top,
                       &layer.v_bottom,
                       &layer.factor_inverse,
                       &layer.remainder})
      *p = take(row);
    layer.ends = take(4 * row);
  }
  for (double** p : {&stack.top_in, &stack.bottom_in, &stack.ground_row, &stack.s_top, &stack.d_top, &stack.s_bottom,
                     &stack.d_bottom})
    *p = take(row);
  stack.ground_matrix = take(square);
  stack.admittance = take((layers + 1) * square);
  stack.offset = take((layers + 1) * row);
  stack.scratch = take((4 * n + 12) * row);
}

}  // namespace sunfleck::pp::detail
