#include "pp_solver/problem.hpp"

#include <cmath>
#include <string>

#include "core/require.hpp"

namespace sunfleck::pp {
namespace {

// Names are put together only when something is wrong: a solve of few streams takes less time than that.
class Checked {
 public:
  Checked() = default;
  explicit Checked(std::size_t layer) : layer_(layer + 1) {}

  template <typename T>
  void require(bool ok, const char* field, const T& value, const char* rule) const {
    if (ok) return;
    const std::string where = layer_ > 0 ? "layer " + std::to_string(layer_) + ", " : "";
    sunfleck::require(false, where + field, value, rule);
  }
  void share(double value, const char* field) const { require(value >= 0. && value <= 1., field, value, "in [0, 1]"); }
  void radiance(double value, const char* field) const {
    require(std::isfinite(value) && value >= 0., field, value, "finite and no less than 0");
  }

 private:
  std::size_t layer_ = 0;
};

bool isDark(const Sky& sky) {
  const double* radiance = std::get_if<double>(&sky);
  return radiance != nullptr && *radiance == 0.;
}

void requireLayer(const Problem& problem, std::size_t index) {
  const Layer& layer = problem.layers[index];
  const Checked is(index);
  const bool infinite = std::isinf(layer.thickness);
  is.require(layer.thickness >= 1e-200, "thickness", layer.thickness, "above 0");
  is.require(!infinite || index + 1 == problem.layers.size(), "thickness", layer.thickness,
             "finite but in the last layer");
  is.radiance(layer.emission_top, "emission_top");
  is.radiance(layer.emission_bottom, "emission_bottom");
  is.require(!infinite || layer.emission_top == layer.emission_bottom, "emission_bottom", layer.emission_bottom,
             "emission_top in an infinite layer");
  if (const auto* particles = std::get_if<Particles>(&layer.medium)) {
    is.share(particles->albedo, "albedo");
    return;
  }
  const auto& leaves = std::get<LeafScattering>(layer.medium);
  is.share(leaves.reflectance, "reflectance");
  is.share(leaves.transmittance, "transmittance");
  is.require(leaves.reflectance + leaves.transmittance <= 1., "reflectance + transmittance",
             leaves.reflectance + leaves.transmittance, "at most 1");
  is.require(layer.emission_top == layer.emission_bottom, "emission_bottom", layer.emission_bottom,
             "emission_top in a layer of leaves");
  is.require(std::isfinite(leaves.hot_spot) && leaves.hot_spot >= 0., "hot_spot", leaves.hot_spot,
             "finite and no less than 0");
  const bool alone = problem.layers.size() == 1 && !infinite && isDark(problem.above) && isDark(problem.below) &&
                     !problem.ground.brdf && problem.ground.emission == 0. && layer.emission_top == 0.;
  is.require(leaves.hot_spot == 0. || alone, "hot_spot", leaves.hot_spot,
             "0 but in a single finite layer lit by the beam alone, on a Lambertian ground");
}

}  // namespace

void requireSolvable(const Problem& problem) {
  const Checked is;
  is.require(!problem.layers.empty(), "number of layers", problem.layers.size(), "one or more");
  for (std::size_t i = 0; i < problem.layers.size(); ++i) requireLayer(problem, i);
  if (problem.beam) {
    is.require(problem.beam->mu0 > 0. && problem.beam->mu0 <= 1., "mu0", problem.beam->mu0, "in (0, 1]");
    is.require(std::isfinite(problem.beam->azimuth), "azimuth", problem.beam->azimuth, "finite");
    is.radiance(problem.beam->irradiance, "irradiance");
  }
  if (const double* radiance = std::get_if<double>(&problem.above)) is.radiance(*radiance, "sky radiance");
  if (const double* radiance = std::get_if<double>(&problem.below)) is.radiance(*radiance, "radiance from below");
  is.require(isDark(problem.below) || !std::isinf(problem.layers.back().thickness), "radiance from below", "some",
             "0 under an infinite layer");
  is.share(problem.ground.albedo, "ground albedo");
  is.radiance(problem.ground.emission, "ground emission");
  is.require(problem.ground.brdf_modes >= 0, "brdf_modes", problem.ground.brdf_modes, "no less than 0");
}

}  // namespace sunfleck::pp
