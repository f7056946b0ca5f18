#include "render/compare/slab_answer.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace sunfleck {

SlabAnswer answer(const SlabModel& model, const SlabQuestion& question) {
  const auto start = std::chrono::steady_clock::now();
  const std::unique_ptr<SlabSolution> slab = model.solve(question.setup);
  SlabAnswer answer{.budget = slab->budget(), .standard_errors = slab->standardErrors(), .streams = slab->streams()};
  const double per_incident = slab->incident() > 0. ? 1. / slab->incident() : 1.;
  for (const double depth : question.depths) {
    pp::Fluxes fluxes = slab->fluxes(depth);
    fluxes.up *= per_incident;
    fluxes.down *= per_incident;
    fluxes.direct *= per_incident;
    answer.fluxes.push_back(fluxes);
  }
  answer.radiances.resize(question.depths.size() * question.mus.size() * question.phis.size());
  if (!answer.radiances.empty()) slab->radiances(question.depths, question.mus, question.phis, answer.radiances);
  answer.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (question.residual) answer.residual = slab->residual();
  return answer;
}

double difference(const SlabAnswer& a, const SlabAnswer& b) {
  double shares = std::max({std::abs(a.budget.reflectance - b.budget.reflectance),
                            std::abs(a.budget.transmittance - b.budget.transmittance),
                            std::abs(a.budget.absorptance - b.budget.absorptance)});
  for (std::size_t i = 0; i < a.fluxes.size(); ++i)
    shares =
        std::max({shares, std::abs(a.fluxes[i].up - b.fluxes[i].up), std::abs(a.fluxes[i].down - b.fluxes[i].down)});
  double radiance = 0., largest = 0.;
  for (std::size_t i = 0; i < a.radiances.size(); ++i) {
    radiance = std::max(radiance, std::abs(a.radiances[i] - b.radiances[i]));
    largest = std::max(largest, std::abs(b.radiances[i]));
  }
  return std::max(shares, largest > 0. ? radiance / largest : 0.);
}

SlabAnswer answerWithin(double tolerance, const SlabModel& model, SlabQuestion question) {
  const auto with = [&](int streams) {
    question.setup.settings.streams = streams;
    return answer(model, question);
  };
  SlabAnswer coarse = with(4);
  for (int streams = 8;; streams *= 2) {
    SlabAnswer fine = with(streams);
    const double change = difference(coarse, fine);
    coarse.difference = fine.difference = change;
    coarse.other_streams = streams;
    fine.other_streams = streams / 2;
    if (change < tolerance) return coarse;
    if (streams == 256) return fine;
    coarse = std::move(fine);
  }
}

}  // namespace sunfleck
