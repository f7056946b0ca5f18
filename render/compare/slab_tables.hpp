#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/progress.hpp"
#include "render/compare/slab_models.hpp"
#include "render/compare/sphere_rule.hpp"

namespace sunfleck {

// One entry of the paper's Table 1 or 2, for one model.
struct SlabTableRow {
  int table;                            // 1 or 2
  double asymmetry, albedo, thickness;  // [1]; thickness may be infinite
  const SlabModel* model;
  double rms;  // [fraction]
};

// The directions, depths and angles over which Tables 1 and 2 take their mean. The paper says "a number of directions
// and depth values"; these are ours.
struct SlabTableGrid {
  std::vector<double> depths;  // 0, 1 ... 10 or the thickness
  SphereRule sphere;
  std::vector<double> mu0s;  // of beams 0, 10 ... 60 degrees from the normal
};
SlabTableGrid slabTableGrid(double thickness);

// (R9) How far a model's diffuse radiance is from the exact one, relative to the power F that arrives on a plane facing
// the beam: sqrt(mean over beams and depths of 1/(4 pi) integral of (I_model - I_exact)^2 ds) / F  [fraction].
//   models  each with a radiance; result[i] is that of models[i]
//   g, albedo, thickness  of the slab; exact solution by `streams` directions
std::vector<double> slabRadianceErrors(std::span<const SlabModel* const> models, double asymmetry, double albedo,
                                       double thickness, int streams = 32);

// All entries of both tables for all models, table by table, on all cores. Ended early by `progress`: an empty list.
std::vector<SlabTableRow> slabTables(std::span<const SlabModel* const> models, const Progress& progress = {});

// Irradiance (P+ + P-) / 2, the mean over leaves inclined as the surface of a sphere, in isotropic slabs of thickness
// 1, 2 .. 16 under an upright beam at eleven depths from face to face: RMS of the model's errors over that of the exact
// values [fraction], as the paper's Eq. 30 has it for trees. result[i] is that of models[i]; exact solution by
// `streams` directions.
std::vector<double> slabIrradianceErrors(std::span<const SlabModel* const> models, double albedo, int streams = 32);
inline constexpr double kIrradianceAlbedo = 0.95;  // of the table

// The models that Tables 1 and 2 judge: all that give a radiance, but the exact one.
std::vector<const SlabModel*> judgedSlabModels();

}  // namespace sunfleck
