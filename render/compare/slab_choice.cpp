#include "render/compare/slab_choice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "spp/tier_choice.hpp"

namespace sunfleck {
namespace {

using spp::SlabQuantity;

const SlabModel& modelOf(const spp::SlabTier& tier) {
  return *findSlabModel(tier.name);
}

bool asksRadiance(const SlabQuestion& question) {
  return !question.mus.empty() && !question.depths.empty();
}

// Why errors are not mapped for what is asked; empty: they are.
std::string whyNotMapped(const SlabQuestion& question) {
  const pp::Problem& problem = question.setup.problem;
  if (!isSlabUnderBeam(problem)) return "layers, a ground, a sky or a hot spot";
  const Medium& medium = problem.layers.front().medium;
  const bool leaves = std::holds_alternative<LeafScattering>(medium);
  if (!spp::mappedMedium(medium))
    return leaves ? fmt::format("leaves inclined otherwise than {}", fmt::join(spp::kMappedAngles, ", "))
                  : "moments of a phase function";
  return leaves && asksRadiance(question) ? "radiance in leaves" : "";
}

double promiseOf(const spp::SlabTier& tier, spp::MappedPlace slab, const SlabQuestion& question) {
  const auto at = [&](double depth, SlabQuantity quantity) {
    slab.depth = depth;
    return spp::promisedError(tier, slab, quantity);
  };
  double error = at(0., SlabQuantity::kFlux);
  if (std::isfinite(slab.thickness)) error += at(slab.thickness, SlabQuantity::kFlux);
  for (const double depth : question.depths) {
    error = std::max({error, at(depth, SlabQuantity::kFlux), at(depth, SlabQuantity::kLeafIrradiance)});
    if (!question.mus.empty()) error = std::max(error, at(depth, SlabQuantity::kRadiance));
  }
  return error;
}

// The exact solver's search, of one case or of many: doubles N until a result changes by less than the error. The last
// is taken, from N = 16 on: N = 4 and 8 agree by chance off the map.
//   solve(cases, N)              results of the cases that are left
//   difference(coarse, fine)
//   take(i, fine, change, N)     the result of the i-th case
template <typename Case, typename Solve, typename Difference, typename Take>
void solveExactly(double max_error, std::vector<Case> cases, const Solve& solve, const Difference& difference,
                  const Take& take) {
  if (cases.empty()) return;
  std::vector<std::size_t> at(cases.size());
  std::iota(at.begin(), at.end(), std::size_t{0});
  auto coarse = solve(cases, 8);
  for (int streams = 16; !cases.empty(); streams *= 2) {
    auto fine = solve(cases, streams);
    std::size_t left = 0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const double change = difference(coarse[i], fine[i]);
      if (change < max_error || streams == 256) {
        take(at[i], fine[i], change, streams);
      } else {
        cases[left] = cases[i];
        fine[left] = fine[i];
        at[left++] = at[i];
      }
    }
    cases.erase(cases.begin() + static_cast<std::ptrdiff_t>(left), cases.end());
    fine.erase(fine.begin() + static_cast<std::ptrdiff_t>(left), fine.end());
    coarse = std::move(fine);
  }
}

}  // namespace

SlabChoice chooseModel(const SlabQuestion& question, double max_error) {
  SlabChoice choice{.promises = {}, .chosen = std::nullopt, .reason = {}, .model = &exactSlabModel()};
  if (const std::string why = whyNotMapped(question); !why.empty()) {
    choice.reason = "errors of closed forms are not mapped for " + why;
    return choice;
  }
  const pp::Layer& layer = question.setup.problem.layers.front();
  const spp::MappedPlace slab{.medium = spp::mappedMedium(layer.medium).value(),
                              .thickness = layer.thickness,
                              .mu0 = question.setup.problem.beam->mu0};
  const bool radiance = asksRadiance(question);
  for (const spp::SlabTier* tier : spp::tiersByCost(radiance)) {
    choice.promises.push_back(
        {tier, promiseOf(*tier, slab, question), radiance ? tier->radiance_cost : tier->power_cost});
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

SlabAnswer answerExactly(double max_error, const SlabQuestion& question) {
  SlabAnswer result;
  const auto solve = [](std::vector<SlabQuestion>& questions, int streams) {
    std::vector<SlabAnswer> answers;
    for (SlabQuestion& asked : questions) {
      asked.setup.settings.streams = streams;
      answers.push_back(answer(exactSlabModel(), asked));
    }
    return answers;
  };
  const auto take = [&](std::size_t, SlabAnswer& fine, double change, int streams) {
    fine.difference = change;
    fine.other_streams = streams / 2;
    result = std::move(fine);
  };
  solveExactly(
      max_error, std::vector{question}, solve,
      [](const SlabAnswer& a, const SlabAnswer& b) { return difference(a, b); }, take);
  return result;
}

std::vector<ChosenFluxes> fluxesWithin(double max_error, std::span<const pp::SlabCase> cases) {
  constexpr std::array kFluxes{SlabQuantity::kFlux};
  std::vector<ChosenFluxes> result(cases.size());
  std::vector<pp::SlabCase> exact;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const spp::MappedPlace top{.medium = spp::MappedParticles{cases[i].asymmetry, cases[i].albedo},
                               .thickness = cases[i].thickness,
                               .mu0 = cases[i].mu0};
    spp::MappedPlace bottom = top;
    bottom.depth = bottom.thickness;
    const std::array faces{top, bottom};
    const spp::SlabTier* tier =
        spp::cheapestTier(std::span(faces).first(std::isfinite(cases[i].thickness) ? 2 : 1), kFluxes, max_error);
    // Each case may be of another medium, whose streams' constants cost more than to solve it exactly in a batch.
    if (!tier || (tier->form != spp::SlabForm::kDirect && tier->form != spp::SlabForm::kSpp)) {
      exact.push_back(cases[i]);
      places.push_back(i);
      continue;
    }
    const SlabBudget budget = modelOf(*tier).solve(homogeneousSlab(cases[i]))->budget();
    result[i] = {{budget.reflectance, budget.transmittance, budget.direct}, std::string(tier->name)};
  }
  const auto solve = [](const std::vector<pp::SlabCase>& left, int streams) {
    std::vector<pp::SlabFluxes> fluxes(left.size());
    pp::solveSlabs(left, fluxes, streams);
    return fluxes;
  };
  const auto take = [&](std::size_t i, const pp::SlabFluxes& fine, double, int streams) {
    result[places[i]] = {fine, fmt::format("pp:{}", streams)};
  };
  solveExactly(
      max_error, std::move(exact), solve,
      [](const pp::SlabFluxes& a, const pp::SlabFluxes& b) {
        return std::max(std::abs(a.reflectance - b.reflectance), std::abs(a.transmittance - b.transmittance));
      },
      take);
  return result;
}

}  // namespace sunfleck
