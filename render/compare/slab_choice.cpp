#include "render/compare/slab_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "spp/tier_choice.hpp"

namespace sunfleck {
namespace {

using spp::SlabQuantity;

const SlabModel& modelOf(const spp::SlabTier& tier) {
  return *findSlabModel(tier.name);
}

spp::SlabPlace placeIn(const pp::SlabCase& slab, double depth) {
  return {slab.asymmetry, slab.albedo, slab.thickness, depth, slab.mu0};
}

double promiseOf(const spp::SlabTier& tier, const SlabQuestion& question) {
  const pp::SlabCase& slab = *question.setup.homogeneous;
  const auto at = [&](double depth, SlabQuantity quantity) {
    return spp::promisedError(tier, placeIn(slab, depth), quantity);
  };
  double error = at(0., SlabQuantity::kFlux);
  if (std::isfinite(slab.thickness)) error += at(slab.thickness, SlabQuantity::kFlux);
  for (const double depth : question.depths) {
    error = std::max({error, at(depth, SlabQuantity::kFlux), at(depth, SlabQuantity::kLeafIrradiance)});
    if (!question.mus.empty()) error = std::max(error, at(depth, SlabQuantity::kRadiance));
  }
  return error;
}

double difference(const pp::SlabFluxes& a, const pp::SlabFluxes& b) {
  return std::max(std::abs(a.reflectance - b.reflectance), std::abs(a.transmittance - b.transmittance));
}

// Doubles N until the result changes by less than the error. The last is taken, from N = 16 on: N = 4 and 8 agree by
// chance off the map.
void solveExactly(double max_error, std::vector<pp::SlabCase> cases, const std::vector<std::size_t>& places,
                  std::vector<ChosenFluxes>& result) {
  if (cases.empty()) return;
  std::vector<std::size_t> at = places;
  std::vector<pp::SlabFluxes> coarse(cases.size());
  pp::solveSlabs(cases, coarse, 8);
  for (int streams = 16; !cases.empty(); streams *= 2) {
    std::vector<pp::SlabFluxes> fine(cases.size());
    pp::solveSlabs(cases, fine, streams);
    std::size_t left = 0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
      if (difference(coarse[i], fine[i]) < max_error || streams == 256) {
        result[at[i]] = {fine[i], fmt::format("pp:{}", streams)};
      } else {
        cases[left] = cases[i];
        fine[left] = fine[i];
        at[left++] = at[i];
      }
    }
    cases.resize(left);
    fine.resize(left);
    coarse = std::move(fine);
  }
}

}  // namespace

SlabChoice chooseModel(const SlabQuestion& question, double max_error) {
  SlabChoice choice{.promises = {}, .chosen = std::nullopt, .reason = {}, .model = &exactSlabModel()};
  if (!question.setup.homogeneous) {
    choice.reason = "errors of closed forms are not mapped for moments, layers, leaves, a ground or a sky";
    return choice;
  }
  const bool radiance = !question.mus.empty() && !question.depths.empty();
  for (const spp::SlabTier* tier : spp::tiersByCost(radiance)) {
    choice.promises.push_back({tier, promiseOf(*tier, question), radiance ? tier->radiance_cost : tier->power_cost});
    if (!choice.chosen && choice.promises.back().error <= max_error) choice.chosen = choice.promises.size() - 1;
  }
  if (choice.chosen) {
    choice.model = &modelOf(*choice.promises[*choice.chosen].tier);
    return choice;
  }
  const auto nearest = std::ranges::min_element(choice.promises, {}, &TierPromise::error);
  choice.reason = std::isinf(nearest->error) ? "the slab is outside of the map of closed forms' errors"
                                             : fmt::format("no closed form keeps it; the nearest, {}, keeps {:.2g} %",
                                                           nearest->tier->name, 100. * nearest->error);
  return choice;
}

std::vector<ChosenFluxes> fluxesWithin(double max_error, std::span<const pp::SlabCase> cases) {
  constexpr std::array kFluxes{SlabQuantity::kFlux};
  std::vector<ChosenFluxes> result(cases.size());
  std::vector<pp::SlabCase> exact;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const std::array faces{placeIn(cases[i], 0.), placeIn(cases[i], cases[i].thickness)};
    const spp::SlabTier* tier =
        spp::cheapestTier(std::span(faces).first(std::isfinite(cases[i].thickness) ? 2 : 1), kFluxes, max_error);
    if (!tier) {
      exact.push_back(cases[i]);
      places.push_back(i);
      continue;
    }
    const SlabBudget budget = modelOf(*tier).solve(homogeneousSlab(cases[i]))->budget();
    result[i] = {{budget.reflectance, budget.transmittance, budget.direct}, std::string(tier->name)};
  }
  solveExactly(max_error, std::move(exact), places, result);
  return result;
}

}  // namespace sunfleck
