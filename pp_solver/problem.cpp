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

// A function can only be tried; the solver looks again at what it uses.
void requireSky(const Sky& sky, const char* field) {
  const Checked is;
  if (const double* radiance = std::get_if<double>(&sky)) return is.radiance(*radiance, field);
  const auto& function = std::get<1>(sky);
  is.require(static_cast<bool>(function), field, "an empty function", "a function");
  for (const double mu : {0.01, 0.3, 0.7, 1.})
    for (const double phi : {0.1, 1.7, 3.3, 4.9}) is.radiance(function(mu, phi), field);
}

void requireLayer(const Problem& problem, std::size_t index) {
  const Layer& layer = problem.layers[index];
  const Checked is(index);
  const bool infinite = std::isinf(layer.thickness);
  is.require(layer.thickness >= kLeastThickness && (infinite || layer.thickness <= kMostThickness), "thickness",
             layer.thickness, "above 0 (1e-100 to 1e100, or infinite)");
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
  is.require(std::isfinite(leaves.hot_spot) && leaves.hot_spot >= 0., "hot_spot", leaves.hot_spot,
             "finite and no less than 0");
  const bool alone = problem.layers.size() == 1 && !infinite && isDark(problem.above) && isDark(problem.below) &&
                     !problem.ground.brdf && problem.ground.emission == 0. && layer.emission_top == 0. &&
                     layer.emission_bottom == 0.;
  is.require(leaves.hot_spot == 0. || alone, "hot_spot", leaves.hot_spot,
             "0 but in a single finite layer lit by the beam alone, on a Lambertian ground");
}

}  // namespace

void requireSolvable(const Problem& problem) {
  const Checked is;
  is.require(!problem.layers.empty(), "number of layers", problem.layers.size(), "one or more");
  for (std::size_t i = 0; i < problem.layers.size(); ++i) requireLayer(problem, i);
  if (problem.beam) {
    is.require(problem.beam->mu0 >= kLeastCosine && problem.beam->mu0 <= 1., "mu0", problem.beam->mu0,
               "in (0, 1] (1e-100 or more)");
    is.require(std::isfinite(problem.beam->azimuth), "azimuth", problem.beam->azimuth, "finite");
    is.radiance(problem.beam->irradiance, "irradiance");
  }
  requireSky(problem.above, "radiance from above");
  requireSky(problem.below, "radiance from below");
  is.require(isDark(problem.below) || !std::isinf(problem.layers.back().thickness), "radiance from below", "some",
             "0 under an infinite layer");
  is.share(problem.ground.albedo, "ground albedo");
  is.radiance(problem.ground.emission, "ground emission");
  if (problem.ground.brdf) {
    is.require(problem.ground.brdf_modes >= 1, "brdf_modes", problem.ground.brdf_modes, "1 or more with a BRDF");
    is.require(problem.ground.albedo == 0., "ground albedo", problem.ground.albedo, "0 beside a BRDF");
  }
}

}  // namespace sunfleck::pp
