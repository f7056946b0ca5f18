#include "render/compare/slab_tables.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <numbers>

#include "render/compare/paper_slab_tables.hpp"

namespace sunfleck {
namespace {

constexpr int kAzimuths = 16;  // midpoints of a half circle: exact for radiance of fewer than 16 azimuth modes squared

// A hemisphere's cosines: 16 nodes on (0, 1), enough for radiance that is smooth in each hemisphere; its steepness at
// grazing angles leaves 1e-4 of the RMS.
constexpr int kCosines = 16;

}  // namespace

SlabTableGrid slabTableGrid(double thickness) {
  SlabTableGrid grid;
  for (int depth = 0; depth <= 10 && depth <= thickness; ++depth) grid.depths.push_back(depth);
  grid.sphere = sphereRule(kCosines, kAzimuths);
  for (int degrees = 0; degrees <= 60; degrees += 10) grid.mu0s.push_back(std::cos(degrees * std::numbers::pi / 180.));
  return grid;
}

std::vector<double> slabRadianceErrors(std::span<const SlabModel* const> models, double asymmetry, double albedo,
                                       double thickness, int streams) {
  const SlabTableGrid grid = slabTableGrid(thickness);
  const std::size_t count = grid.depths.size() * grid.sphere.directions();
  std::vector<double> exact(count), approximate(count), errors(models.size(), 0.);
  for (const double mu0 : grid.mu0s) {
    const SlabSetup setup = homogeneousSlab(
        {.asymmetry = asymmetry, .albedo = albedo, .thickness = thickness, .mu0 = mu0}, {.streams = streams});
    exactSlabModel().solve(setup)->radiances(grid.depths, grid.sphere.mus, grid.sphere.phis, exact);
    for (std::size_t m = 0; m < models.size(); ++m) {
      models[m]->solve(setup)->radiances(grid.depths, grid.sphere.mus, grid.sphere.phis, approximate);
      for (std::size_t k = 0; k < count; ++k) {
        const double deviation = approximate[k] - exact[k];
        errors[m] += grid.sphere.weights[k / grid.sphere.phis.size() % grid.sphere.mus.size()] * deviation * deviation;
      }
    }
  }
  const auto parts = static_cast<double>(grid.mu0s.size() * grid.depths.size() * grid.sphere.phis.size());
  for (double& error : errors) error = std::sqrt(error / parts);
  return errors;
}

std::vector<SlabTableRow> slabTables(std::span<const SlabModel* const> models, const Progress& progress) {
  struct Case {
    double asymmetry, albedo, thickness;
    std::vector<double> errors;
  };
  std::vector<Case> cases;
  for (const paper::Table1Column& column : paper::kTable1)
    for (const paper::Table2Column& other : paper::kTable2)
      for (const double albedo : paper::kAlbedos) cases.push_back({column.asymmetry, albedo, other.thickness, {}});

  std::mutex telling;
  std::size_t done = 0;
  std::atomic<bool> stopped = false;
  tbb::parallel_for(std::size_t{0}, cases.size(), [&](std::size_t i) {
    if (stopped) return;
    cases[i].errors = slabRadianceErrors(models, cases[i].asymmetry, cases[i].albedo, cases[i].thickness);
    const std::scoped_lock lock(telling);
    if (!goOn(progress, static_cast<double>(++done) / static_cast<double>(cases.size()))) stopped = true;
  });
  if (stopped) return {};

  std::vector<SlabTableRow> rows;
  for (const int table : {1, 2})
    for (const Case& entry : cases)
      if (table == 2 || entry.thickness == paper::kTable1Thickness)
        for (std::size_t m = 0; m < models.size(); ++m)
          rows.push_back({table, entry.asymmetry, entry.albedo, entry.thickness, models[m], entry.errors[m]});
  return rows;
}

std::vector<double> slabIrradianceErrors(std::span<const SlabModel* const> models, double albedo, int streams) {
  std::vector<double> errors(models.size(), 0.);
  double size = 0.;
  for (int thickness = 1; thickness <= 16; ++thickness) {
    const SlabSetup setup =
        homogeneousSlab({.albedo = albedo, .thickness = static_cast<double>(thickness)}, {.streams = streams});
    const std::unique_ptr<SlabSolution> exact = exactSlabModel().solve(setup);
    std::vector<std::unique_ptr<SlabSolution>> slabs;
    for (const SlabModel* model : models) slabs.push_back(model->solve(setup));
    for (int i = 0; i <= 10; ++i) {
      const double depth = 0.1 * i * thickness, right = exact->fluxes(depth).mean_intensity;
      size += right * right;
      for (std::size_t m = 0; m < models.size(); ++m)
        errors[m] += std::pow(slabs[m]->fluxes(depth).mean_intensity - right, 2);
    }
  }
  for (double& error : errors) error = std::sqrt(error / size);
  return errors;
}

std::vector<const SlabModel*> judgedSlabModels() {
  std::vector<const SlabModel*> models;
  for (const SlabModel& model : slabModels())
    if (model.gives_radiance && !model.is_sample && &model != &exactSlabModel()) models.push_back(&model);
  return models;
}

}  // namespace sunfleck
