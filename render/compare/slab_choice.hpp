#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/compare/slab_answer.hpp"
#include "spp/slab_tiers.hpp"

namespace sunfleck {

// A closed form that may answer a question, and the error it keeps of all that is asked; infinite: none is promised.
struct TierPromise {
  const spp::SlabTier* tier;
  double error;
  double cost;  // over that of SPP's powers
};

// (S14) The cheapest way to answer a question within an error.
struct SlabChoice {
  std::vector<TierPromise> promises;  // of all tiers that answer such a question, the cheapest first
  std::optional<std::size_t> chosen;  // of the promises; none: the exact solver
  std::string reason;                 // why the exact solver
  const SlabModel* model;             // that is to answer

  const TierPromise* promise() const { return chosen ? &promises[*chosen] : nullptr; }
};

// What is asked: the shares at both faces; at each of the question's depths the fluxes, relative to what arrives, and
// the irradiance of leaves, relative to itself or to spp::kDimIrradiance, whichever is more, which among particles is
// the mean intensity; and if it has cosines, the radiance there, RMS over all directions for a beam of irradiance 1.
// What is absorbed may be off by the errors of both faces together, which is counted.
SlabChoice chooseModel(const SlabQuestion& question, double max_error);

// By the exact solver with the smallest N of 16, 32 ... 256 whose answer is nearer than max_error to that of N / 2.
SlabAnswer answerExactly(double max_error, const SlabQuestion& question);

// The reflectance and transmittance of a slab of a file, and by which model.
struct ChosenFluxes {
  pp::SlabFluxes fluxes;
  std::string model;  // ss, spp or pp:N; pp:256 may be farther from N = 128 than max_error
};
// Each by direct light or SPP where these keep max_error of both, or else by the exact solver by the same rule: more
// streams cost more for a single slab, constants and all, than the exact solver in a batch. Assumes valid cases.
std::vector<ChosenFluxes> fluxesWithin(double max_error, std::span<const pp::SlabCase> cases);

}  // namespace sunfleck
