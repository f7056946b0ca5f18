#pragma once

#include "pp_solver/detail/stack.hpp"

// The numerical kernel, compiled for several instruction sets; kernel() is the best that this machine has.
namespace sunfleck::pp::detail {

// Light along one direction within one layer. Rows as in stack.hpp.
struct View {
  const double *even, *odd;  // how the direction receives light, in the space of the layer's x and y
  const double* rate;        // extinction per depth along the view, times 1 / mu [1 per lane]
  int levels;
  const double* depth;  // [levels] below the layer's top
  double *down, *up;    // [levels] out: what the layer sends along the direction to that depth
};

// The same functions for one problem and for as many as a vector has lanes.
struct KernelPath {
  int lanes;
  void (*scatterRows)(const BasisRows&, const double* scatter, const double* mu, const double* first, double* even,
                      double* odd);
  void (*solve)(const BasisRows&, StackRows&);
  void (*fieldAt)(const BasisRows&, const LayerRows&, const double* depth, double* u, double* v);
  void (*viewLayer)(const BasisRows&, const LayerRows&, const View&, double* scratch);
};

constexpr int kMostLanes = 8;

struct Kernel {
  int lanes;  // numbers in a vector
  KernelPath single, wide;
};

const Kernel& kernel();

// Makes rows for `layers` layers, or keeps those there are.
void shape(StackRows& stack, const BasisRows& basis, int layers);

}  // namespace sunfleck::pp::detail
