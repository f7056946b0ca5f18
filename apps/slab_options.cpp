#include "apps/slab_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "apps/number_text.hpp"
#include "apps/slab_files.hpp"
#include "core/require.hpp"

namespace sunfleck::apps {
namespace {

constexpr double kDegree = std::numbers::pi / 180.;

void requireFinite(double value, const char* name, const char* rule, double low, double high) {
  require(std::isfinite(value) && value >= low && value <= high, name, value, rule);
}

// "spherical", "ellipsoidal:1.5", "beta:57,20" with angles in degrees.
LeafAngles leafAngles(const std::string& text) {
  const std::size_t colon = text.find(':');
  const std::string name = text.substr(0, colon);
  std::vector<double> numbers;
  for (std::size_t at = colon; at != std::string::npos;) {
    const std::size_t next = text.find(',', at + 1);
    const std::optional<double> value = numberOf(std::string_view(text).substr(at + 1, next - at - 1));
    if (!value || !std::isfinite(*value))
      throw InvalidInput("leaves = " + text + ": must have numbers after the colon");
    numbers.push_back(*value);
    at = next;
  }
  const auto takes = [&](std::size_t count, const char* form) {
    if (numbers.size() != count) throw InvalidInput("leaves = " + text + ": must be " + form);
  };
  if (name == "ellipsoidal") {
    takes(1, "ellipsoidal:RATIO, horizontal over vertical axis");
    require(numbers[0] > 0., "leaves: ellipsoidal ratio", numbers[0], "above 0");
    return LeafAngles::ellipsoidal(numbers[0]);
  }
  if (name == "beta") {
    takes(2, "beta:MEAN,DEVIATION, in degrees");
    require(numbers[0] > 0. && numbers[0] < 90., "leaves: mean of beta", numbers[0], "above 0, below 90 degrees");
    require(numbers[1] > 0. && numbers[1] < 45., "leaves: deviation of beta", numbers[1], "above 0, below 45 degrees");
    return LeafAngles::beta(numbers[0] * kDegree, numbers[1] * kDegree);
  }
  takes(0, "without a number");
  return LeafAngles::named(name.c_str());
}

LeafScattering leafScattering(const SlabOptions& options) {
  requireFinite(options.leaf_reflectance, "reflectance", "in [0, 1]", 0., 1.);
  requireFinite(options.leaf_transmittance, "transmittance", "in [0, 1]", 0., 1.);
  const double albedo = options.leaf_reflectance + options.leaf_transmittance;
  require(albedo <= 1. + 1e-15, "reflectance + transmittance", albedo, "at most 1");
  requireFinite(options.hot_spot, "hot-spot", "in [0, 10]", 0., 10.);
  return {.angles = leafAngles(options.leaves),
          .reflectance = options.leaf_reflectance,
          .transmittance = std::min(options.leaf_transmittance, 1. - options.leaf_reflectance),
          .hot_spot = options.hot_spot};
}

std::vector<pp::Layer> layersOf(const SlabOptions& options, const pp::SlabCase& slab) {
  if (!options.layers.empty()) return readLayers(options.layers);
  if (!options.leaves.empty()) return {{.thickness = slab.thickness, .medium = leafScattering(options)}};
  if (!options.moments.empty())
    return {{.thickness = slab.thickness,
             .medium = Particles{.albedo = slab.albedo, .phase = readMoments(options.moments)}}};
  return homogeneousSlab(slab).problem.layers;
}

void addDirections(const SlabOptions& options, SlabQuestion& question) {
  const double thickness = totalThickness(question);
  question.depths = options.depths;
  for (const double depth : options.depths)
    require(depth >= 0. && depth <= thickness && std::isfinite(depth), "depth", depth,
            fmt::format("finite and in [0, {}], the thickness", thickness));
  question.mus = options.mus;
  for (const double mu : options.mus)
    require(mu >= -1. && mu <= 1. && mu != 0., "mu", mu, "in [-1, 1] and not 0; above 0 is downward");
  for (const double phi : options.phis) {
    requireFinite(phi, "phi", "degrees in [-360, 360]", -360., 360.);
    question.phis.push_back(phi * kDegree);
  }
  const bool directions = !options.mus.empty() || !options.phis.empty();
  if (directions && question.depths.empty()) {
    question.depths = {0.};
    if (std::isfinite(thickness)) question.depths.push_back(thickness);
  }
  if (question.depths.empty()) return;
  if (question.mus.empty()) question.mus = {1., -1.};
  if (question.phis.empty()) question.phis = {0.};
}

}  // namespace

void requireSlabCase(const pp::SlabCase& slab, const std::string& where) {
  const auto check = [&](bool ok, const char* name, double value, const char* rule) {
    if (!ok) require(false, where + name, value, rule);
  };
  check(slab.asymmetry > -1. && slab.asymmetry < 1., "g", slab.asymmetry, "in (-1, 1)");
  check(slab.albedo >= 0. && slab.albedo <= 1., "omega", slab.albedo, "in [0, 1]");
  const bool thick =
      slab.thickness >= pp::kLeastThickness && (slab.thickness <= pp::kMostThickness || std::isinf(slab.thickness));
  check(thick, "thickness", slab.thickness, "above 0 (1e-100 to 1e100); inf is allowed");
  check(slab.mu0 >= pp::kLeastCosine && slab.mu0 <= 1., "mu0", slab.mu0, "in (0, 1] (1e-100 or more)");
}

std::optional<double> shareOf(std::string_view text) {
  const bool percent = text.ends_with('%');
  if (percent) text.remove_suffix(1);
  std::optional<double> share = numberOf(text);
  if (share && percent) share = *share / 100.;
  if (!share || !(*share >= 1e-15 && *share <= 1.)) return std::nullopt;
  return share;
}

std::vector<const SlabModel*> chosenModels(const SlabOptions& options) {
  std::string names;
  for (const SlabModel& model : slabModels()) names += (names.empty() ? "" : ", ") + std::string(model.name);
  std::vector<const SlabModel*> models;
  for (const std::string& name : options.models) {
    const SlabModel* model = findSlabModel(name);
    if (!model)
      throw InvalidInput("model = " + name + ": must be one of " + names +
                         ", or nstream:N[:ORDERS], N from 1 to 8, ORDERS from 1 to 2 N or all");
    if (std::ranges::find(models, model) != models.end())
      throw InvalidInput("model = " + name + ": stands there twice");
    models.push_back(model);
  }
  return models;
}

double totalThickness(const SlabQuestion& question) {
  double thickness = 0.;
  for (const pp::Layer& layer : question.setup.problem.layers) thickness += layer.thickness;
  return thickness;
}

pp::Settings exactSettings(const SlabOptions& options) {
  return {.streams = options.streams.value_or(kBatchStreams),
          .delta_m = !options.no_delta_m,
          .corrections = !options.no_corrections,
          .collocation = options.collocation};
}

void requireExactFor(const SlabOptions& options, const std::vector<const SlabModel*>& models) {
  if (std::ranges::find(models, &exactSlabModel()) != models.end()) return;
  const auto refuse = [&](bool given, const char* option) {
    if (given) throw InvalidInput(fmt::format("{}: is for the model {} alone", option, exactSlabModel().name));
  };
  refuse(options.streams.has_value(), "--streams");
  refuse(options.tolerance.has_value(), "--tolerance");
  refuse(options.no_delta_m, "--no-delta-m");
  refuse(options.no_corrections, "--no-corrections");
  refuse(options.collocation, "--collocation");
  refuse(options.residual, "--residual");
}

SlabQuestion slabQuestion(const SlabOptions& options) {
  const pp::SlabCase slab{.asymmetry = options.asymmetry,
                          .albedo = options.albedo,
                          .thickness = options.thickness,
                          .mu0 = options.mu0.value_or(1.)};
  requireSlabCase(slab, "");
  requireFinite(options.ground_albedo, "ground-albedo", "in [0, 1]", 0., 1.);
  SlabQuestion question;
  pp::Problem& problem = question.setup.problem;
  problem.layers = layersOf(options, slab);
  problem.ground.albedo = options.ground_albedo;
  if (options.sky) {
    requireFinite(*options.sky, "sky", "above 0, at most 1e6", 1e-300, 1e6);
    problem.above = *options.sky;
  }
  if (!options.sky || options.mu0) problem.beam = pp::Beam{.mu0 = slab.mu0};
  question.setup.settings = exactSettings(options);
  if (options.paths) question.setup.effort.paths = static_cast<std::uint64_t>(*options.paths);
  const bool special = !options.layers.empty() || !options.leaves.empty() || !options.moments.empty() || options.sky ||
                       options.ground_albedo > 0.;
  if (!special) question.setup.homogeneous = slab;
  addDirections(options, question);
  question.residual = options.residual;
  question.leaf_angles = options.leaves;
  return question;
}

void requireCapable(const SlabModel& model, const SlabQuestion& question) {
  if (takes(model, question.setup)) return;
  throw InvalidInput(fmt::format("model = {}: must be pp for {}", model.name,
                                 model.scope == SlabScope::henyey_greenstein
                                     ? "moments, layers, leaves, a ground or a sky"
                                     : "layers, a hot spot, a ground or a sky"));
}

}  // namespace sunfleck::apps
