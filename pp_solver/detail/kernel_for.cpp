// Compiled once for each instruction set (sunfleck_kernel in cmake/module.cmake).
#include "pp_solver/detail/boundaries.hpp"
#include "pp_solver/detail/kernel.hpp"
#include "pp_solver/detail/radiance.hpp"

namespace sunfleck::pp::SUNFLECK_ISA {
namespace {

template <typename S>
void scatterRowsOf(const BasisRows& basis, const double* scatter, const double* mu, const double* first, double* even,
                   double* odd) {
  pp::SUNFLECK_ISA::scatterRows<S>(basis, numbers<S>(rows(scatter)), numbers<S>(rows(mu))[0],
                                   numbers<S>(rows(first))[0], rows(even), rows(odd));
}

// Whether the sum and the difference of both ends of the only layer hold what crosses it with nearly all its digits:
// the light that comes out is no less than a thousandth of what entered, in the slowest mode.
template <typename S>
bool seesThrough(const BasisRows& basis, const LayerRows& layer) {
  S most{}, slowest{};
  for (int j = 0; j < basis.n; ++j) {
    most = maximum(most, numbers<S>(rows(layer.through))[j]);
    slowest = maximum(slowest, numbers<S>(rows(layer.s))[j]);
  }
  return all(most > 1e-3) && all(slowest < 1e3);
}

template <typename S>
void solveOf(const BasisRows& basis, StackRows& stack) {
  const LayerRows* last = nullptr;
  const auto prepare = [&](LayerRows& layer) {
    if (last == nullptr || !takeModes<S>(basis, layer, *last)) {
      if (!layer.given_modes) layerModes<S>(basis, layer, rows(stack.scratch));
      modesAtNodes<S>(basis, layer);
    }
    last = &layer;
    layerPassage<S>(basis, layer);
  };
  if (stack.layers == 1 && stack.black && !stack.layer[0].infinite) {
    prepare(stack.layer[0]);
    if (seesThrough<S>(basis, stack.layer[0])) return oneLayer<S>(basis, stack);
    return layerStack<S>(basis, stack, [](LayerRows&) {});
  }
  layerStack<S>(basis, stack, prepare);
}

template <typename S>
constexpr detail::KernelPath path() {
  return {.lanes = kWide<S> ? kLanes : 1,
          .scatterRows = scatterRowsOf<S>,
          .solve = solveOf<S>,
          .fieldAt = fieldAt<S>,
          .viewLayer = viewLayer<S>};
}

}  // namespace

static_assert(kLanes <= detail::kMostLanes);
extern const detail::Kernel the_kernel;
constinit const detail::Kernel the_kernel{.lanes = kLanes, .single = path<double>(), .wide = path<Vec>()};

}  // namespace sunfleck::pp::SUNFLECK_ISA
