#include <fmt/format.h>

#include <array>
#include <map>
#include <memory>
#include <mutex>

#include "apps/commands.hpp"
#include "apps/slab_batch.hpp"
#include "apps/slab_options.hpp"
#include "apps/slab_output.hpp"
#include "apps/slab_plot.hpp"
#include "apps/terminal.hpp"
#include "core/require.hpp"
#include "core/whole_file.hpp"

namespace sunfleck::apps {
namespace {

constexpr int kEndedEarly = 1;

// What solves the lines of a file: one model, or the cheapest that keeps the error; then it counts whose turn it was.
SolveCases solverOf(const SlabModel& model, const pp::Settings& settings) {
  if (&model == &exactSlabModel())
    return [settings](std::span<const pp::SlabCase> cases) {
      std::vector<pp::SlabFluxes> fluxes(cases.size());
      pp::solveSlabs(cases, fluxes, settings.streams, settings.delta_m);
      std::vector<ChosenFluxes> results;
      for (const pp::SlabFluxes& solved : fluxes) results.push_back({solved, {}});
      return results;
    };
  return [&model, settings](std::span<const pp::SlabCase> cases) {
    std::vector<ChosenFluxes> results;
    for (const pp::SlabCase& slab : cases) try {
        const SlabBudget budget = model.solve(homogeneousSlab(slab, settings))->budget();
        results.push_back({{budget.reflectance, budget.transmittance, budget.direct}, {}});
      } catch (const InvalidInput& e) {
        throw InvalidInput(fmt::format("g = {}, omega = {}, thickness = {}, mu0 = {}: {}", slab.asymmetry, slab.albedo,
                                       slab.thickness, slab.mu0, e.what()));
      }
    return results;
  };
}

struct TurnCount {
  std::mutex lock;
  std::map<std::string, std::size_t> turns;
};

SolveCases solverWithin(double max_error, TurnCount& count) {
  return [max_error, &count](std::span<const pp::SlabCase> cases) {
    std::vector<ChosenFluxes> results = fluxesWithin(max_error, cases);
    const std::scoped_lock lock(count.lock);
    for (const ChosenFluxes& chosen : results) ++count.turns[chosen.model];
    return results;
  };
}

int runBatch(const SlabOptions& options, const RunOptions& run) {
  const std::optional<double> max_error = shareOf(options.max_error);
  const std::vector<const SlabModel*> models = chosenModels(options);
  if (models.size() != 1) throw InvalidInput("--batch: must have one model");
  if (models.front()->is_sample) throw InvalidInput("--batch: must have a model other than mc, too slow for a file");
  requireExactFor(options, models);
  if (run.json) throw InvalidInput("--json: does not go with --batch, which writes CSV");
  if (!options.output.empty()) requireWritable(options.output);
  TurnCount count;
  const SolveCases solve =
      max_error ? solverWithin(*max_error, count) : solverOf(*models.front(), exactSettings(options));
  if (!solveBatch(options.batch, solve, max_error.has_value(), options.output,
                  terminalProgress("solving", run.quiet))) {
    fmt::print(stderr, "sunfleck: interrupted: nothing was written\n");
    return kEndedEarly;
  }
  if (max_error && !run.quiet)
    for (const auto& [model, rows] : count.turns) fmt::print(stderr, "{:>12}: {} rows\n", model, rows);
  return 0;
}

std::string plotted(const SlabOptions& options, std::span<const SlabModel* const> models,
                    const SlabQuestion& question) {
  std::vector<const SlabModel*> shown;
  for (const SlabModel* model : models)
    if (model->gives_radiance && !model->is_sample) shown.push_back(model);
  if (shown.empty()) throw InvalidInput("--plot: must have a model other than mc");
  writeWhole(options.plot, slabPlot(shown, question, options.plot_log));
  return fmt::format("\nwrote {}\n", options.plot);
}

// Radiance is asked for by a direction or a plot: a closed form that is to keep an error has to know.
int runWithin(double max_error, const SlabOptions& options, const RunOptions& run) {
  SlabQuestion question = slabQuestion(options);
  if (!options.plot.empty()) {
    requireNamed(options.plot, ".svg");
    if (question.depths.empty()) question.depths = plotDepths(question);
    if (question.mus.empty()) question.mus = {1., -1.};
    if (question.phis.empty()) question.phis = {0.};
  } else if (options.mus.empty() && options.phis.empty()) {
    question.mus.clear();
  }
  const SlabChoice choice = chooseModel(question, max_error);
  const ModelAnswer given{choice.model,
                          choice.promise() ? answer(*choice.model, question) : answerExactly(max_error, question)};
  if (!choice.promise()) question.setup.settings.streams = given.answer.streams;
  std::string text =
      run.json ? slabJson(question, given, choice, max_error) : slabText(question, given, choice, max_error);
  if (!options.plot.empty()) {
    const std::string wrote = plotted(options, std::array{choice.model}, question);
    if (!run.json) text += wrote;
  }
  fmt::print("{}", text);
  return 0;
}

int runSlab(const SlabOptions& options, const RunOptions& run) {
  if (!options.batch.empty()) return runBatch(options, run);
  if (const auto max_error = shareOf(options.max_error)) return runWithin(*max_error, options, run);
  const std::vector<const SlabModel*> models = chosenModels(options);
  SlabQuestion question = slabQuestion(options);
  requireExactFor(options, models);
  for (const SlabModel* model : models) requireCapable(*model, question);
  if (!options.plot.empty()) requireNamed(options.plot, ".svg");

  const double tolerance = options.tolerance.value_or(kTolerance);
  std::vector<ModelAnswer> answers;
  for (const SlabModel* model : models) {
    SlabQuestion asked = question;
    asked.setup.effort.seed = run.seed;
    asked.setup.effort.threads = run.threads;
    if (!model->gives_radiance) asked.mus.clear();
    const bool choose = !options.streams && model == &exactSlabModel();
    answers.push_back({model, choose ? answerWithin(tolerance, *model, asked) : answer(*model, asked)});
    if (choose) question.setup.settings.streams = answers.back().answer.streams;
    if (interrupted()) return kEndedEarly;
  }
  std::string text;
  if (run.json) {
    text = slabJson(question, answers);
  } else {
    for (const ModelAnswer& given : answers) text += (text.empty() ? "" : "\n") + slabText(question, given, tolerance);
  }
  if (!options.plot.empty()) {
    const std::string wrote = plotted(options, models, question);
    if (!run.json) text += wrote;
  }
  fmt::print("{}", text);
  return 0;
}

// A number, infinity included: CLI11 takes an empty text for 0.
CLI::Validator number() {
  return CLI::Validator(
      [](const std::string& text) {
        double value = 0.;
        return !text.empty() && CLI::detail::lexical_cast(text, value) ? std::string()
                                                                       : "\"" + text + "\": must be a number";
      },
      "");
}

CLI::Validator share() {
  return CLI::Validator(
      [](const std::string& text) {
        return shareOf(text) ? std::string()
                             : "\"" + text + "\": must be a share or per cent, such as 0.01 or 1%, 1e-15 to 1";
      },
      "");
}

CLI::Validator evenStreams() {
  return CLI::Validator(
      [](const std::string& text) {
        int value = 0;
        const bool ok = CLI::detail::lexical_cast(text, value) && value >= 2 && value <= 256 && value % 2 == 0;
        return ok ? std::string() : "\"" + text + "\": must be an even whole number, 2 to 256";
      },
      "");
}

struct Options {
  CLI::App& command;
  CLI::Option* add(const char* name, auto& value, const char* about, const char* group) {
    return command.add_option(name, value, about)->group(group);
  }
  CLI::Option* addNumber(const char* name, auto& value, const char* about, const char* group) {
    return add(name, value, about, group)->check(number());
  }
  CLI::Option* addFlag(const char* name, bool& value, const char* about, const char* group) {
    return command.add_flag(name, value, about)->group(group);
  }
};

void exclude(CLI::Option* option, std::initializer_list<CLI::Option*> others) {
  for (CLI::Option* other : others) option->excludes(other);
}

}  // namespace

void addSlab(CLI::App& app, RunOptions& run, int& status) {
  auto slab = std::make_shared<SlabOptions>();
  CLI::App* command = addCommand(app, run, "slab", "Solve one plane-parallel slab, or a file of them");
  Options options{*command};
  std::string names;
  for (const SlabModel& model : slabModels())
    names += fmt::format("{}{}: {}", names.empty() ? "" : "; ", model.name, model.label);
  auto* model = options.add("--model", slab->models, "", "Model")->delimiter(',');
  model->description(
      "One or more, such as pp,spp (default pp). " + names +
      "; nstream:N[:ORDERS]: N streams of each half, 1 to 8, and as many azimuth orders, or all (default "
      "2). Closed forms, from spp to nstream, take one slab of any medium under a beam on black ground");
  auto* streams = options.add(
      "--streams", slab->streams,
      "N, directions of the exact solver over both hemispheres; even, 2 to 256 (default: by --tolerance; of "
      "a batch 32)",
      "Model");
  streams->check(evenStreams());
  auto* tolerance =
      options.add("--tolerance", slab->tolerance,
                  "Choose N: the smallest of 4, 8, 16 ... 256 whose result differs from the next one's by "
                  "less than this (default 1e-6)",
                  "Model");
  tolerance->check(numberIn(1e-15, 1., "a number, 1e-15 to 1"));
  auto* max_error = options.add("--max-error", slab->max_error,
                                "Choose the model: the cheapest closed form whose measured error of what is printed is "
                                "at most this, such as 1% or 0.01, or else the exact solver",
                                "Model");
  max_error->check(share());
  auto* no_delta_m = options.addFlag("--no-delta-m", slab->no_delta_m,
                                     "Cut the phase function's series at N moments, without delta-M", "Model");
  auto* no_corrections = options.addFlag("--no-corrections", slab->no_corrections,
                                         "Radiance by N moments of the phase function, without corrections", "Model");
  auto* collocation = options.addFlag(
      "--collocation", slab->collocation,
      "Scatter between the directions as DISORT does, to compare with it digit by digit; slower", "Model");
  auto* paths = options.add("--paths", slab->paths, "Paths of the model mc, 64 to 10^12 (default 200000)", "Model");
  paths->check(numberIn(64., 1e12, "a number, 64 to 10^12"));
  auto* residual = options.addFlag("--residual", slab->residual,
                                   "Put the solution back into its equation and print what remains", "Model");

  const char* medium = "Slab";
  auto* omega = options.addNumber("--omega", slab->albedo, "Single-scattering albedo, 0 to 1 (default 0.95)", medium);
  auto* g = options.addNumber("--g", slab->asymmetry,
                              "Asymmetry of Henyey-Greenstein scattering, above -1, below 1 (default 0)", medium);
  auto* moments =
      options.add("--moments", slab->moments,
                  "File of the phase function's Legendre moments, chi_0 = 1 first, by lines or commas", medium);
  auto* thickness = options.addNumber("--thickness", slab->thickness,
                                      "Optical thickness, of leaves: leaf area index; above 0; inf for a half space "
                                      "(default 10)",
                                      medium);
  auto* layers =
      options.add("--layers", slab->layers, "CSV file of layers from the top down, columns thickness,omega,g", medium);
  auto* ground = options.addNumber("--ground-albedo", slab->ground_albedo,
                                   "Albedo of Lambert's ground under the slab (default 0)", medium);
  auto* leaves = options.add("--leaves", slab->leaves,
                             "Leaves instead of particles, inclined as: spherical, planophile, erectophile, "
                             "plagiophile, extremophile, uniform, ellipsoidal:RATIO or beta:MEAN,DEVIATION in degrees",
                             medium);
  auto* reflectance = options.addNumber("--reflectance", slab->leaf_reflectance, "Of a leaf (default 0.475)", medium);
  auto* transmittance =
      options.addNumber("--transmittance", slab->leaf_transmittance, "Of a leaf (default 0.475)", medium);
  auto* hot_spot =
      options.addNumber("--hot-spot", slab->hot_spot,
                        "Leaf diameter over canopy height, which makes the hot spot (default 0: none)", medium);

  const char* light = "Light";
  auto* mu0 = options.addNumber("--mu0", slab->mu0,
                                "|cos| of the beam to the slab's normal, above 0, at most 1 (default 1); its azimuth "
                                "is 0",
                                light);
  auto* sky = options.addNumber("--sky", slab->sky,
                                "Radiance of diffuse light from above, the same from everywhere, in place of the beam; "
                                "with --mu0: beside a beam of irradiance 1",
                                light);

  const char* results = "Results";
  const auto list = [&](const char* name, std::vector<double>& values, const char* about) {
    return options.addNumber(name, values, about, results)->delimiter(',');
  };
  auto* depths = list("--depths", slab->depths, "Depths to print the light at, such as 0,1,5");
  auto* mus = list("--mu", slab->mus,
                   "Cosines of directions to print radiance for, to the downward vertical: above 0 travels down; such "
                   "as 1,0.5,-0.5 (default 1,-1)");
  auto* phis = list("--phi", slab->phis, "Their azimuths of travel in degrees, such as 0,90,180 (default 0)");
  auto* plot = options.add("--plot", slab->plot,
                           "Draw radiance in the principal plane into this SVG file, at --depths or at the top, middle "
                           "and bottom",
                           results);
  auto* plot_log = options.addFlag("--plot-log", slab->plot_log, "With a logarithmic radius", results);
  auto* batch = options.add("--batch", slab->batch,
                            "Solve all slabs of this CSV file, columns g,omega,thickness,mu0; written back with "
                            "reflectance,transmittance,direct",
                            results);
  auto* output = options.add("-o", slab->output, "File for the results of --batch, instead of stdout", results);

  exclude(streams, {tolerance});
  exclude(max_error, {model, streams, tolerance, no_delta_m, no_corrections, collocation, paths, residual});
  exclude(moments, {g});
  exclude(leaves, {omega, g, moments});
  exclude(layers, {omega, g, moments, thickness, leaves});
  exclude(batch, {omega, g, moments, thickness, layers, ground, leaves, mu0, sky, depths, mus, phis, plot, tolerance,
                  no_corrections, collocation, paths, residual});
  for (CLI::Option* option : {reflectance, transmittance, hot_spot}) option->needs(leaves);
  plot_log->needs(plot);
  output->needs(batch);
  for (CLI::Option* option : {model, moments, layers, leaves, plot, batch, output})
    option->check([](const std::string& text) { return text.empty() ? "must not be empty" : std::string(); });
  command->callback([slab, &run, &status] { status = runSlab(*slab, run); });
}

}  // namespace sunfleck::apps
