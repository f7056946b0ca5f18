#include "pp_solver/problem.hpp"

#include <cmath>
#include <string>

#include "core/require.hpp"

namespace sunfleck::pp {
namespace {

void requireShare(double value, const std::string& what) {
  require(value >= 0. && value <= 1., what, value, "in [0, 1]");
}

void requireRadiance(double value, const std::string& what) {
  require(std::isfinite(value) && value >= 0., what, value, "finite and no less than 0");
}

}  // namespace

void requireSolvable(const Problem& problem) {
  require(!problem.layers.empty(), "number of layers", problem.layers.size(), "one or more");
  bool infinite = false;
  for (size_t i = 0; i < problem.layers.size(); ++i) {
    const Layer& layer = problem.layers[i];
    const std::string where = "layer " + std::to_string(i + 1) + ", ";
    const bool last = i + 1 == problem.layers.size();
    require(layer.thickness >= 1e-200, where + "thickness", layer.thickness, "above 0");
    infinite = std::isinf(layer.thickness);
    require(!infinite || last, where + "thickness", layer.thickness, "finite but in the last layer");
    requireRadiance(layer.emission_top, where + "emission_top");
    requireRadiance(layer.emission_bottom, where + "emission_bottom");
    require(!infinite || layer.emission_top == layer.emission_bottom, where + "emission_bottom", layer.emission_bottom,
            "emission_top in an infinite layer");
    if (const auto* particles = std::get_if<Particles>(&layer.medium)) {
      requireShare(particles->albedo, where + "albedo");
    } else {
      const auto& leaves = std::get<LeafScattering>(layer.medium);
      requireShare(leaves.reflectance, where + "reflectance");
      requireShare(leaves.transmittance, where + "transmittance");
      require(leaves.reflectance + leaves.transmittance <= 1., where + "reflectance + transmittance",
              leaves.reflectance + leaves.transmittance, "at most 1");
      require(std::isfinite(leaves.hot_spot) && leaves.hot_spot >= 0., where + "hot_spot", leaves.hot_spot,
              "finite and no less than 0");
      require(layer.emission_top == layer.emission_bottom, where + "emission_bottom", layer.emission_bottom,
              "emission_top in a layer of leaves");
    }
  }
  if (problem.beam) {
    require(problem.beam->mu0 > 0. && problem.beam->mu0 <= 1., "mu0", problem.beam->mu0, "in (0, 1]");
    require(std::isfinite(problem.beam->azimuth), "azimuth", problem.beam->azimuth, "finite");
    requireRadiance(problem.beam->irradiance, "irradiance");
  }
  if (const double* radiance = std::get_if<double>(&problem.above)) requireRadiance(*radiance, "sky radiance");
  if (const double* radiance = std::get_if<double>(&problem.below)) {
    requireRadiance(*radiance, "radiance from below");
    require(!infinite || *radiance == 0., "radiance from below", *radiance, "0 under an infinite layer");
  } else {
    require(!infinite, "radiance from below", "a function", "0 under an infinite layer");
  }
  requireShare(problem.ground.albedo, "ground albedo");
  requireRadiance(problem.ground.emission, "ground emission");
  require(problem.ground.brdf_modes >= 0, "brdf_modes", problem.ground.brdf_modes, "no less than 0");
}

}  // namespace sunfleck::pp
