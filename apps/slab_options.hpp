#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "render/compare/slab_answer.hpp"

namespace sunfleck::apps {

inline constexpr int kBatchStreams = 32;
inline constexpr double kTolerance = 1e-6;

// What `sunfleck slab` is told. Angles are in degrees, as typed.
struct SlabOptions {
  std::vector<std::string> models{"pp"};
  double albedo = 0.95;                                         // omega [1]
  double asymmetry = 0.;                                        // g [1]
  double thickness = 10.;                                       // optical, or leaf area index [1]
  std::optional<double> mu0;                                    // [1]; 1 unless there is a sky
  std::string moments;                                          // file of Legendre moments
  std::string layers;                                           // CSV file of layers
  std::string leaves;                                           // distribution of leaf angles
  double leaf_reflectance = 0.475, leaf_transmittance = 0.475;  // [1]
  double hot_spot = 0.;                                         // leaf size over canopy height [1]
  double ground_albedo = 0.;                                    // [1]
  std::optional<double> sky;                                    // radiance from above [1/sr]
  std::optional<int> streams;       // else chosen by the tolerance; of a batch kBatchStreams
  std::optional<double> tolerance;  // kTolerance unless there are streams
  std::string max_error;            // a share, or per cent with its sign; empty: the models are told
  bool no_delta_m = false, no_corrections = false, collocation = false, residual = false;
  std::optional<double> paths;  // of Monte Carlo
  std::vector<double> depths, mus, phis;
  std::string batch, output, plot;
  bool plot_log = false;
};

// The share that --max-error tells: "0.01" or "1%", 1e-15 .. 1. Nothing for another text.
std::optional<double> shareOf(std::string_view text);

// The models by their names. Throws InvalidInput for a name there is none of, or one twice.
std::vector<const SlabModel*> chosenModels(const SlabOptions& options);

// The slab told by the options and by the files they name, the depths and directions asked for. Throws InvalidInput for
// a value out of its range, a file that is wrong, or a model that cannot do it.
SlabQuestion slabQuestion(const SlabOptions& options);
void requireCapable(const SlabModel& model, const SlabQuestion& question);

pp::Settings exactSettings(const SlabOptions& options);

// Throws InvalidInput when options of the exact solver are given but it is not among the models.
void requireExactFor(const SlabOptions& options, const std::vector<const SlabModel*>& models);

double totalThickness(const SlabQuestion& question);

// Throws InvalidInput("<where>g = ...") unless the case is in range.
void requireSlabCase(const pp::SlabCase& slab, const std::string& where);

}  // namespace sunfleck::apps
