#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/image.hpp"
#include "core/progress.hpp"
#include "render/compare/category_errors.hpp"
#include "render/leaf_models.hpp"
#include "render/reference/forward_trace.hpp"
#include "render/scene.hpp"

namespace sunfleck {

struct ValidationEffort {
  TraceEffort trace{.paths = 4'000'000};
  bool with_wood = false;  // whether wood stops light in the reference; the models know leaves only
  int band = 0;            // of the scene's optics, 0 .. kBands - 1
};

struct ModelResult {
  Model model = Model::ss;
  std::vector<float> irradiance;  // of each leaf [1]
  ModelErrors errors;
  double prepare_seconds = 0.;  // per placement of trees and light: what the one before has not left
  double shade_seconds = 0.;    // all leaves
};

// Every model against Monte Carlo on one scene.
struct Validation {
  Scene scene;
  ValidationEffort effort;
  LeafDepths depths;                            // mean over the stand's trees
  double mean_depth = 0., mean_thickness = 0.;  // over leaves [1]
  std::size_t leaves = 0, leaf_triangles = 0;   // of the prototypes
  double leaf_area = 0.;                        // one-sided, of the prototypes [m^2]
  ForwardResult reference;  // of all suns and the sky; what is told by shares of the light is of the first sun
  std::optional<double> reference_noise;  // see referenceNoise()
  // Expected rms_weighted of a perfect model, from the reference's standard errors; nothing when all is dark.
  std::optional<double> category_noise;
  std::vector<Category> categories;
  std::size_t leaves_left_out = 0;  // in categories of fewer than 5
  std::vector<ModelResult> models;

  std::vector<LeafOptics> optics() const;  // of each kind of tree
  double albedo() const;                   // of their leaves, the mean over their area [1]
};

// The scene's sun, sky, leaves, wood, media and ground in these bands, for Monte Carlo. Throws InvalidInput as
// sunAndSky() does.
std::vector<TraceLight> traceLights(const Scene& scene, const std::vector<int>& bands);
TraceLight traceLight(const Scene& scene, int band);  // the same in one
// The same for each sun that shines, whose light adds up: the sky is with the first. At least one, if a dark one.
std::vector<std::vector<TraceLight>> traceLightsOfSuns(const Scene& scene, const std::vector<int>& bands);

std::string kindOf(const Scene& scene);  // "single tree", "16 trees" or "periodic"
std::string labelOf(Model model);        // "SS", "SPP", ... "NSTREAMG"

// Throws InvalidInput on a scene that a model cannot be judged on in a band: the field where there are too many leaves
// for it, a gloss, suns that are no points, or a ground that reflects under a stand that does not repeat; the others
// where there is more light than that of one sun of irradiance 1 (requireModelled()), or a ground that reflects.
void requireValidatable(const Scene& scene, Model model, int band);
// Those that can; throws InvalidInput where there is none.
std::vector<Model> judgedModels(const Scene& scene, int band);

// `stand` is up to date for the scene, with G for the models that ask for it. Throws InvalidInput as judgedModels()
// does. What is ended early is judged by the paths done; the field, if it is not done then, is left out.
//   field_progress  of the light field, which is solved last
Validation validate(const Scene& scene, const StandGeometry& stand, const ValidationEffort& effort,
                    const Progress& progress = {}, const Progress& field_progress = {});

}  // namespace sunfleck
