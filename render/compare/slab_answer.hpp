#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/compare/slab_models.hpp"

namespace sunfleck {

// A slab and what one wants to know of it.
struct SlabQuestion {
  SlabSetup setup;
  std::vector<double> depths;
  std::vector<double> mus;   // cos to the downward vertical [1]; none: no radiance is asked
  std::vector<double> phis;  // azimuth of travel [rad]
  bool residual = false;
  std::string leaf_angles;  // of a layer of leaves, for people
};

struct SlabAnswer {
  SlabBudget budget;
  std::vector<pp::Fluxes> fluxes;  // at each depth, per incident flux, but for mean intensity and leaf irradiance
  std::vector<double> radiances;   // [(d * mus + i) * phis + j]
  std::optional<double> residual;
  std::optional<SlabBudget> standard_errors;  // of a sample
  int streams = 0;
  double seconds = 0.;  // that the model took
  // Where the number of streams was chosen: how far the answer of another number is.
  std::optional<double> difference;
  int other_streams = 0;
};

SlabAnswer answer(const SlabModel& model, const SlabQuestion& question);

// The answer of the smallest number of streams among 4, 8, 16 ... 256 whose answer is nearer than `tolerance` to that
// of the next: in every share of the budget and of the fluxes, and in every radiance relative to the largest. Where
// none is, that of 256, with its difference from 128.
SlabAnswer answerWithin(double tolerance, const SlabModel& model, SlabQuestion question);

// The largest difference of two answers to one question, by the measure above.
double difference(const SlabAnswer& a, const SlabAnswer& b);

}  // namespace sunfleck
