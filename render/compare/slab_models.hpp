#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "pp_solver/problem.hpp"
#include "pp_solver/slab_batch.hpp"
#include "pp_solver/solver.hpp"
#include "render/reference/forward_trace.hpp"
#include "spp/slab_tiers.hpp"

namespace sunfleck {

// What a model of a slab is asked.
struct SlabSetup {
  pp::Problem problem;
  pp::Settings settings;                    // of the exact solver
  std::optional<pp::SlabCase> homogeneous;  // the same problem, where it is one slab of Henyey-Greenstein particles on
                                            // black ground under a beam of irradiance 1 and azimuth 0
  TraceEffort effort{.paths = 200'000};     // of Monte Carlo
};
SlabSetup slabUnderBeam(Medium medium, double thickness, double mu0, const pp::Settings& settings = {});
SlabSetup homogeneousSlab(const pp::SlabCase& slab, const pp::Settings& settings = {});

// Where the light that arrives ends up, as shares of it [1].
struct SlabBudget {
  double reflectance, transmittance, direct, absorptance;  // transmittance includes direct
};

// A slab that one model has solved. Depths, cosines and azimuths are those of pp::Solver, which see.
class SlabSolution {
 public:
  virtual ~SlabSolution() = default;
  virtual SlabBudget budget() const = 0;
  virtual double incident() const = 0;                // flux that arrives
  virtual pp::Fluxes fluxes(double depth) const = 0;  // in the unit of `incident`
  // Of diffuse light [1/sr, per irradiance 1]: result[(d * mus.size() + i) * phis.size() + j].
  virtual void radiances(std::span<const double> depths, std::span<const double> mus, std::span<const double> phis,
                         std::span<double> result) = 0;
  virtual int streams() const = 0;  // directions over both hemispheres that the model solves for
  // Where the model is a sample: the standard error of each share.
  virtual std::optional<SlabBudget> standardErrors() const { return std::nullopt; }
  // How far the solution is from its own equation, where the model can tell: pp::Solver::residual.
  virtual std::optional<double> residual() { return std::nullopt; }
};

// The problems that a model takes.
enum class SlabScope {
  any,               // layers, ground, sky
  slab_under_beam,   // isSlabUnderBeam()
  henyey_greenstein  // SlabSetup::homogeneous
};

// A model as the command line and the comparisons know it. A new one is a new line of slabModels().
struct SlabModel {
  std::string name;   // as typed
  std::string label;  // for people
  SlabScope scope;
  bool gives_radiance;  // else fluxes alone
  bool is_sample;       // Monte Carlo: answers have standard errors, and mean intensity is not among them
  std::function<std::unique_ptr<SlabSolution>(const SlabSetup& setup)> solve;
};

// Whether the problem is one homogeneous layer of any medium, without a hot spot, on black ground under a beam of
// irradiance 1 and azimuth 0.
bool isSlabUnderBeam(const pp::Problem& problem);
bool takes(const SlabModel& model, const SlabSetup& setup);

// The exact solver first.
std::span<const SlabModel> slabModels();
const SlabModel& exactSlabModel();
// One of slabModels(), or nstream:N and nstream:N:ORDERS: N = 1 .. 8 streams of each half and 1 .. 2 N azimuth orders,
// or all (else 2). nullptr: there is none of this name.
const SlabModel* findSlabModel(std::string_view name);

}  // namespace sunfleck
