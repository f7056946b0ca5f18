#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pp_solver/slab_batch.hpp"
#include "pp_solver/solver.hpp"

// Random plane-parallel problems, most of them in corners where solvers break: mu0 on, and 1e-15 beside, a node of the
// quadrature; albedo 0, 1 and the numbers beside 1; |g| to .999; thickness 1e-12 .. 1e12 and infinite; 1 to 50 layers.
namespace sunfleck::stress {

struct StressProblem {
  pp::Settings settings;
  pp::Problem problem;
  bool isothermal = false;                // a closed cavity: radiance is `problem.above` everywhere
  std::vector<double> depths, mus, phis;  // where radiance is asked for; none for most
};

// A function of (seed, index) alone.
StressProblem drawProblem(std::uint64_t seed, std::uint64_t index);

// All cases of a batch have the directions of batchStreams.
int batchStreams(std::uint64_t seed, std::uint64_t batch);
pp::SlabCase drawCase(std::uint64_t seed, std::uint64_t index, int streams);

// All values, to 17 digits, in the order of the fields.
std::string describe(const StressProblem& problem);
std::string describe(const pp::SlabCase& slab, int streams);

}  // namespace sunfleck::stress
