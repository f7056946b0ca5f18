#include "apps/slab_output.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

namespace sunfleck::apps {
namespace {

using Json = nlohmann::ordered_json;

// An azimuth as it was typed: radians and back leave a last digit.
double degrees(double radians) {
  return std::round(radians * 180. / std::numbers::pi * 1e9) / 1e9;
}

// Without the sign of what is 0 but for rounding.
double shown(double flux) {
  return std::abs(flux) < 1e-15 ? 0. : flux;
}

double radianceAt(const SlabQuestion& question, const SlabAnswer& answer, std::size_t d, std::size_t i, std::size_t j) {
  return answer.radiances[(d * question.mus.size() + i) * question.phis.size() + j];
}

std::string fluxTable(const SlabQuestion& question, const SlabAnswer& answer, bool is_sample) {
  const bool leaves = !question.leaf_angles.empty();
  std::string text = fmt::format(
      "\nFluxes, as shares of the flux that arrives; mean intensity in the unit of radiance{}\n"
      "{:>12} {:>14} {:>14} {:>14} {:>16}{}\n",
      leaves ? ";\nleaf irradiance of both sides together, per one-sided leaf area" : "", "depth", "down, diffuse",
      "down, direct", "up", "mean intensity", leaves ? "  leaf irradiance" : "");
  for (std::size_t d = 0; d < question.depths.size(); ++d) {
    const pp::Fluxes& f = answer.fluxes[d];
    text += fmt::format("{:12.6g} {:14.8f} {:14.8f} {:14.8f} {:>16}{}\n", question.depths[d], shown(f.down), f.direct,
                        shown(f.up), is_sample ? "-" : fmt::format("{:.8g}", f.mean_intensity),
                        leaves ? fmt::format(" {:16.8g}", f.leaf_irradiance) : "");
  }
  return text;
}

std::string radianceTable(const SlabQuestion& question, const SlabAnswer& answer) {
  std::string text = fmt::format(
      "\nDiffuse radiance [{}]; mu > 0 travels downward\n{:>12} {:>12}",
      question.setup.problem.beam ? "1/sr, per irradiance 1 of a plane that faces the beam" : "unit of the sky's",
      "depth", "mu");
  for (const double phi : question.phis) text += fmt::format(" {:>14}", fmt::format("phi {:g} deg", degrees(phi)));
  text += '\n';
  for (std::size_t d = 0; d < question.depths.size(); ++d)
    for (std::size_t i = 0; i < question.mus.size(); ++i) {
      text += fmt::format("{:12.6g} {:12.6g}", question.depths[d], question.mus[i]);
      for (std::size_t j = 0; j < question.phis.size(); ++j)
        text += fmt::format(" {:14.8g}", radianceAt(question, answer, d, i, j));
      text += '\n';
    }
  return text;
}

Json jsonOf(const SlabQuestion& question, const SlabAnswer& answer, bool is_sample) {
  Json radiance = Json::array(), fluxes = Json::array();
  for (std::size_t d = 0; d < question.depths.size(); ++d) {
    const pp::Fluxes& f = answer.fluxes[d];
    fluxes.push_back({{"depth", question.depths[d]}, {"down", f.down}, {"direct", f.direct}, {"up", f.up}});
    if (!is_sample) fluxes.back()["mean_intensity"] = f.mean_intensity;
    if (!question.leaf_angles.empty()) fluxes.back()["leaf_irradiance"] = f.leaf_irradiance;
    if (answer.radiances.empty()) continue;
    for (std::size_t i = 0; i < question.mus.size(); ++i)
      for (std::size_t j = 0; j < question.phis.size(); ++j)
        radiance.push_back({{"depth", question.depths[d]},
                            {"mu", question.mus[i]},
                            {"phi_deg", degrees(question.phis[j])},
                            {"value", radianceAt(question, answer, d, i, j)}});
  }
  Json json{{"reflectance", answer.budget.reflectance},
            {"transmittance", answer.budget.transmittance},
            {"direct", answer.budget.direct},
            {"absorptance", answer.budget.absorptance},
            {"radiance", std::move(radiance)},
            {"fluxes", std::move(fluxes)},
            {"streams", answer.streams},
            {"seconds", answer.seconds}};
  if (answer.difference) json["difference"] = *answer.difference;  // from the next number of streams
  if (answer.residual) json["residual"] = *answer.residual;
  if (answer.standard_errors)
    json["standard_errors"] = {{"reflectance", answer.standard_errors->reflectance},
                               {"transmittance", answer.standard_errors->transmittance},
                               {"absorptance", answer.standard_errors->absorptance}};
  return json;
}

std::string percent(double error) {
  if (std::isinf(error)) return "not known";
  return error < 0.995 ? fmt::format("{:.2g} %", 100. * error) : fmt::format("{:.0f} %", 100. * error);
}

std::string choiceText(const SlabQuestion& question, const SlabChoice& choice, double max_error) {
  std::string text = fmt::format("Within {:.6g} %: ", 100. * max_error);
  if (!choice.promise()) return text + fmt::format("the exact solver, since {}\n\n", choice.reason);
  text += fmt::format("{}, at most {} off in {}{}\n", choice.model->name, percent(choice.promise()->error),
                      question.depths.empty()        ? "shares"
                      : question.leaf_angles.empty() ? "shares, fluxes and mean intensity"
                                                     : "shares, fluxes and leaf irradiance",
                      question.mus.empty() ? "" : ", and in radiance as RMS over all directions");
  text += fmt::format("{:>16} {:>10} {:>12}\n", "closed form", "cost", "may be off");
  for (const TierPromise& promise : choice.promises)
    text += fmt::format("{:>16} {:>10.3g} {:>12}{}\n", promise.tier->name, promise.cost, percent(promise.error),
                        &promise == choice.promise() ? "  <- the cheapest that keeps it" : "");
  return text + "cost: time at one depth over that of spp's fluxes\n\n";
}

Json choiceJson(const SlabChoice& choice, double max_error) {
  Json promises = Json::array();
  for (const TierPromise& promise : choice.promises) {
    Json entry{{"model", promise.tier->name}, {"cost", promise.cost}, {"promised_error", nullptr}};
    if (std::isfinite(promise.error)) entry["promised_error"] = promise.error;
    promises.push_back(std::move(entry));
  }
  Json json{{"model", choice.model->name}, {"max_error", max_error}};
  if (choice.promise())
    json["promised_error"] = choice.promise()->error;
  else
    json["reason"] = choice.reason;
  json["closed_forms"] = std::move(promises);
  return json;
}

}  // namespace

std::string slabText(const SlabQuestion& question, const ModelAnswer& answer, const SlabChoice& choice,
                     double max_error) {
  return choiceText(question, choice, max_error) + slabText(question, answer, max_error);
}

std::string slabJson(const SlabQuestion& question, const ModelAnswer& answer, const SlabChoice& choice,
                     double max_error) {
  Json json = choiceJson(choice, max_error);
  json.update(jsonOf(question, answer.answer, false));
  return json.dump(2) + "\n";
}

std::string slabText(const SlabQuestion& question, const ModelAnswer& given, double tolerance) {
  const SlabAnswer& answer = given.answer;
  const SlabBudget& budget = answer.budget;
  const std::string effort = given.model->is_sample ? fmt::format(", {} paths", question.setup.effort.paths)
                             : answer.streams > 0   ? fmt::format(", N = {}", answer.streams)
                                                    : "";
  std::string text =
      fmt::format("{} ({}){}{:>12.3g} ms\n", given.model->name, given.model->label, effort, 1e3 * answer.seconds);
  if (answer.difference)
    text += *answer.difference < tolerance
                ? fmt::format("N = {} is within {:.2g} of N = {}\n", answer.streams, *answer.difference,
                              answer.other_streams)
                : fmt::format("the tolerance of {:.2g} is not reached: N = {} is {:.2g} from N = {}\n", tolerance,
                              answer.streams, *answer.difference, answer.other_streams);
  const auto line = [&](const char* name, double SlabBudget::*share) {
    text += fmt::format("  {:<14} {:.12f}", name, budget.*share);
    if (answer.standard_errors && (*answer.standard_errors).*share > 0.)
      text += fmt::format(" +- {:.1e}", (*answer.standard_errors).*share);
    text += '\n';
  };
  text += "\nShares of the flux that arrives\n";
  line("reflectance", &SlabBudget::reflectance);
  line("transmittance", &SlabBudget::transmittance);
  line("  direct", &SlabBudget::direct);
  line("absorptance", &SlabBudget::absorptance);
  if (const double albedo = question.setup.problem.ground.albedo; albedo > 0.)
    text += fmt::format("  in the ground  {:.12f}\n", (1. - albedo) * budget.transmittance);
  if (question.leaf_angles.size() > 0 &&
      std::get<LeafScattering>(question.setup.problem.layers[0].medium).hot_spot > 0. && !question.depths.empty())
    text +=
        "\nthe hot spot is in the shares, the fluxes of both faces and the radiance at the top, not within the layer\n";
  if (!question.depths.empty()) text += fluxTable(question, answer, given.model->is_sample);
  if (!answer.radiances.empty()) text += radianceTable(question, answer);
  if (answer.residual)
    text += fmt::format("\nresidual of the transfer equation at the nodes, over the largest radiance: {:.2g}\n",
                        *answer.residual);
  return text;
}

std::string slabJson(const SlabQuestion& question, const std::vector<ModelAnswer>& answers) {
  if (answers.size() == 1)
    return jsonOf(question, answers.front().answer, answers.front().model->is_sample).dump(2) + "\n";
  Json models = Json::array();
  for (const ModelAnswer& given : answers) {
    Json json{{"model", given.model->name}};
    json.update(jsonOf(question, given.answer, given.model->is_sample));
    models.push_back(std::move(json));
  }
  return Json{{"models", std::move(models)}}.dump(2) + "\n";
}

}  // namespace sunfleck::apps
