#include "apps/slab_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/compare/radiance_plot.hpp"

namespace sunfleck::apps {
namespace {

using std::numbers::pi;
constexpr double kDegree = pi / 180.;

// 0 to 180 degrees from the downward vertical, up to the horizon from either side.
std::vector<double> halfCircle() {
  std::vector<double> angles;
  for (int i = 0; i < 90; ++i) angles.push_back(i * kDegree);
  angles.insert(angles.end(), {89.5 * kDegree, 89.95 * kDegree, 90.05 * kDegree, 90.5 * kDegree});
  for (int i = 91; i <= 180; ++i) angles.push_back(i * kDegree);
  return angles;
}

std::vector<PrincipalPlane> principalPlanes(const SlabModel& model, SlabSolution& slab,
                                            const std::vector<double>& depths) {
  const std::vector<double> half = halfCircle();
  std::vector<double> mus;
  for (const double angle : half) mus.push_back(std::cos(angle));
  const std::vector<double> phis{0., pi};
  std::vector<double> values(depths.size() * mus.size() * 2);
  slab.radiances(depths, mus, phis, values);
  std::vector<PrincipalPlane> planes;
  for (std::size_t d = 0; d < depths.size(); ++d) {
    PrincipalPlane plane{.model = std::string(model.name), .depth = depths[d], .angles = {}, .radiances = {}};
    const auto value = [&](std::size_t i, std::size_t j) { return values[(d * mus.size() + i) * 2 + j]; };
    for (std::size_t i = 0; i < half.size(); ++i) {
      plane.angles.push_back(half[i]);
      plane.radiances.push_back(value(i, 0));
    }
    for (std::size_t i = half.size(); i-- > 0;) {
      plane.angles.push_back(2. * pi - half[i]);
      plane.radiances.push_back(value(i, 1));
    }
    planes.push_back(std::move(plane));
  }
  return planes;
}

RadianceMap radianceMap(const SlabModel& model, SlabSolution& slab, double depth) {
  constexpr double kNearHorizon = 89.95 * kDegree;
  RadianceMap map{.model = std::string(model.name), .depth = depth, .zeniths = 46, .azimuths = 46, .values = {}};
  std::vector<double> mus, phis;
  for (const double side : {1., -1.})
    for (int i = 0; i < map.zeniths; ++i)
      mus.push_back(side * std::cos(std::min(kNearHorizon, 0.5 * pi * i / (map.zeniths - 1))));
  for (int j = 0; j < map.azimuths; ++j) phis.push_back(pi * j / (map.azimuths - 1));
  map.values.resize(mus.size() * phis.size());
  slab.radiances(std::vector{depth}, mus, phis, map.values);
  return map;
}

std::string subtitleOf(std::span<const SlabModel* const> models, const SlabQuestion& question) {
  const pp::Problem& problem = question.setup.problem;
  std::string text;
  if (const auto& slab = question.setup.homogeneous)
    text = fmt::format("omega {:g}, g {:g}, thickness {:g}", slab->albedo, slab->asymmetry, slab->thickness);
  else if (const auto* leaves = std::get_if<LeafScattering>(&problem.layers[0].medium))
    text = fmt::format("{} leaves, reflectance {:g}, transmittance {:g}, leaf area index {:g}{}", question.leaf_angles,
                       leaves->reflectance, leaves->transmittance, totalThickness(question),
                       leaves->hot_spot > 0. ? fmt::format(", hot spot {:g}", leaves->hot_spot) : "");
  else if (problem.layers.size() == 1)
    text = fmt::format("omega {:g}, thickness {:g}", std::get<Particles>(problem.layers[0].medium).albedo,
                       totalThickness(question));
  else
    text = fmt::format("{} layers, thickness {:g}", problem.layers.size(), totalThickness(question));
  if (problem.beam) text += fmt::format(", mu0 {:g}", problem.beam->mu0);
  if (const double* sky = std::get_if<double>(&problem.above); sky != nullptr && *sky > 0.)
    text += fmt::format(", sky {:g}", *sky);
  if (problem.ground.albedo > 0.) text += fmt::format(", ground albedo {:g}", problem.ground.albedo);
  if (std::ranges::find(models, &exactSlabModel()) != models.end())
    text += fmt::format("; N = {}", question.setup.settings.streams);
  return text;
}

}  // namespace

std::vector<double> plotDepths(const SlabQuestion& question) {
  if (!question.depths.empty()) return question.depths;
  const double thickness = totalThickness(question);
  return std::isfinite(thickness) ? std::vector{0., 0.5 * thickness, thickness} : std::vector{0., 1., 10.};
}

std::string slabPlot(std::span<const SlabModel* const> models, const SlabQuestion& question, bool logarithmic) {
  std::vector<double> depths = plotDepths(question);
  std::ranges::sort(depths);
  const auto repeated = std::ranges::unique(depths);
  depths.erase(repeated.begin(), repeated.end());

  const auto& beam = question.setup.problem.beam;
  RadiancePlot plot{.title = fmt::format("Diffuse radiance in the principal plane [{}{}]",
                                         beam ? "1/sr, per unit irradiance of the beam" : "unit of the sky's",
                                         logarithmic ? "; logarithmic" : ""),
                    .subtitle = subtitleOf(models, question),
                    .logarithmic = logarithmic};
  if (beam) plot.beam_mu0 = beam->mu0;
  for (const SlabModel* model : models) {
    const auto slab = model->solve(question.setup);
    std::ranges::move(principalPlanes(*model, *slab, depths), std::back_inserter(plot.planes));
    if (!plot.map) plot.map = radianceMap(*model, *slab, depths[depths.size() / 2]);
  }
  return radiancePlot(plot);
}

}  // namespace sunfleck::apps
