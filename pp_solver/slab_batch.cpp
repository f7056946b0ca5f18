#include "pp_solver/slab_batch.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "pp_solver/detail/kernel.hpp"
#include "pp_solver/detail/rounding.hpp"
#include "pp_solver/detail/scaled_moments.hpp"

namespace sunfleck::pp {
namespace {

using detail::BasisRows;
using detail::KernelPath;
using detail::LayerRows;
using detail::StackRows;

// Lanes are worth while until the matrices of all lanes no longer fit the nearest cache.
constexpr int kWidestStreams = 32;

// One thread's memory.
struct Worker {
  StackRows stack;
  std::vector<double> moments;
};

// Puts a case into one lane.
void fill(const BasisRows& basis, StackRows& stack, int lane, const SlabCase& slab, bool delta_m,
          std::vector<double>& moments, double* mu, double* first) {
  LayerRows& layer = stack.layer[0];
  const int lanes = basis.lanes, streams = 2 * basis.n;
  moments.resize(static_cast<std::size_t>(streams) + 1);
  double power = 1.;
  for (double& moment : moments) {
    moment = power;
    power *= slab.asymmetry;
  }
  const double scale = detail::scaleMoments(slab.albedo, moments.data(), streams, delta_m, layer.scatter + lane, lanes);
  for (int l = 0; l < streams; ++l) layer.loss[l * lanes + lane] = 1. - layer.scatter[l * lanes + lane];
  layer.loss[lane] = (1. - slab.albedo) / scale;
  layer.thickness[lane] = slab.thickness * scale;
  layer.rate[lane] = 1. / slab.mu0;
  mu[lane] = slab.mu0;
  first[lane] = 0.5 / (std::numbers::pi * slab.mu0);  // irradiance 1 / mu0: a flux of 1 arrives
}

// Solves as many cases as `basis` has lanes; lanes beyond the end repeat the last case.
void solve(const BasisRows& basis, const KernelPath& path, Worker& worker, std::span<const SlabCase> cases,
           std::span<SlabFluxes> result, bool infinite, bool delta_m) {
  alignas(64) double mu[detail::kMostLanes], first[detail::kMostLanes];
  StackRows& stack = worker.stack;
  shape(stack, basis, 1);
  LayerRows& layer = stack.layer[0];
  layer.infinite = infinite;
  for (int lane = 0; lane < basis.lanes; ++lane) {
    SlabCase slab = cases[std::min<std::size_t>(lane, cases.size() - 1)];
    if (!infinite && std::isinf(slab.thickness)) slab.thickness = 1.;  // solved by itself
    fill(basis, stack, lane, slab, delta_m, worker.moments, mu, first);
  }
  path.scatterRows(basis, layer.scatter, mu, first, layer.even_source, layer.odd_source);
  path.solve(basis, stack);
  for (std::size_t lane = 0; lane < cases.size(); ++lane) {
    const SlabCase& slab = cases[lane];
    if (std::isinf(slab.thickness) != infinite) continue;
    double up = 0., down = 0.;
    for (int i = 0; i < basis.n; ++i) {
      const std::size_t at = i * basis.lanes + lane;
      up += basis.flat[at] * (stack.s_top[at] - stack.d_top[at]);
      if (!infinite) down += basis.flat[at] * (stack.s_bottom[at] + stack.d_bottom[at]);
    }
    const double beam = infinite ? 0. : std::exp(-layer.thickness[lane] / slab.mu0);
    result[lane] = {.reflectance = detail::withoutRounding(std::numbers::pi * up),
                    .transmittance = detail::withoutRounding(std::numbers::pi * down + beam),
                    .direct = std::exp(-slab.thickness / slab.mu0)};
  }
}

}  // namespace

void solveSlabs(std::span<const SlabCase> cases, std::span<SlabFluxes> result, int streams, bool delta_m) {
  const auto ordinates = Ordinates::of(streams);
  const detail::Kernel& kernel = detail::kernel();
  const BasisRows single(*ordinates, 0, false, kernel.lanes, false);
  const bool wide = streams <= kWidestStreams;
  const BasisRows basis(*ordinates, 0, false, kernel.lanes, wide);
  const KernelPath& path = wide ? kernel.wide : kernel.single;
  const std::size_t lanes = basis.lanes, bundles = (cases.size() + lanes - 1) / lanes;
  struct Workers {
    Worker bundle, alone;
  };
  tbb::enumerable_thread_specific<Workers> workers;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, bundles, 16), [&](const auto& range) {
    Workers& mine = workers.local();
    for (std::size_t bundle = range.begin(); bundle != range.end(); ++bundle) {
      const std::size_t from = bundle * lanes, count = std::min(lanes, cases.size() - from);
      solve(basis, path, mine.bundle, cases.subspan(from, count), result.subspan(from, count), false, delta_m);
      for (std::size_t i = from; i < from + count; ++i)
        if (std::isinf(cases[i].thickness))
          solve(single, kernel.single, mine.alone, cases.subspan(i, 1), result.subspan(i, 1), true, delta_m);
    }
  });
}

}  // namespace sunfleck::pp
