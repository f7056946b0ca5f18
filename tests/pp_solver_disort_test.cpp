// Check that the exact solver gives the published solutions that DISORT is tested by.
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

#include "pp_solver/solver.hpp"

namespace {

using namespace sunfleck;
using nlohmann::json;

// By name; left out is 6a, which has no medium.
json problems() {
  std::ifstream file(SUNFLECK_SOURCE_DIR "/tests/disort_problems.json");
  return json::parse(file).at("cases");
}

// Planck's radiance between two wavenumbers [1/cm] at a temperature [K], with DISORT's constants:
// 15 / pi^4 sigma T^4 / pi times the integral of x^3 / (e^x - 1); above x = 60 it is 1e-21 of the whole.
double planck(const json& wavenumbers, double temperature) {
  if (temperature == 0.) return 0.;
  constexpr double kC2 = 1.438786, kSigma = 5.67032e-8;
  const double least = kC2 * wavenumbers.at(0).get<double>() / temperature,
               most = std::min(60., kC2 * wavenumbers.at(1).get<double>() / temperature);
  const double integral = boost::math::quadrature::gauss_kronrod<double, 31>::integrate(
      [](double x) { return x == 0. ? 0. : x * x * x / std::expm1(x); }, least, most, 10, 1e-12);
  return 15. * kSigma / std::pow(std::numbers::pi, 5) * std::pow(temperature, 4) * integral;
}

// Hapke's reflectivity (1993, eq. 8.89 times pi / mu0) with DISORT's parameters, which takes phi = 0 for where light is
// sent back.
double hapke(double mu, double mu_in, double phi) {
  constexpr double kAlbedo = 0.6, kWidth = 0.06;
  const double cosine = mu * mu_in + std::sqrt((1. - mu * mu) * (1. - mu_in * mu_in)) * std::cos(phi);
  const double opposition = kWidth / (kWidth + std::tan(0.5 * std::acos(std::min(cosine, 1.))));
  const auto h = [](double x) { return (1. + 2. * x) / (1. + 2. * x * std::sqrt(1. - kAlbedo)); };
  return 0.25 * kAlbedo / (mu + mu_in) * ((1. + opposition) * (1. + 0.5 * cosine) + h(mu) * h(mu_in) - 1.);
}

// Mean over (0, 1) by the 25 points that DISORT has for the azimuth, over pi, and for the cosines of what a ground
// emits: at the opposition's peak they are felt.
template <typename Function>
double meanByGauss(Function f) {
  return 0.5 * boost::math::quadrature::gauss<double, 25>::integrate([&](double x) { return f(0.5 * (1. + x)); });
}

// As DISORT has it: the emissivity is 1 less the directional albedo by that rule, and so no Ground's emission.
void setHapkeGround(pp::Problem& problem, int modes, double emission) {
  problem.ground.brdf_modes = modes;
  problem.ground.brdf = [](int mode, double mu, double mu_in) {
    const double mean = meanByGauss(
        [&](double x) { return hapke(mu, mu_in, std::numbers::pi * x) * std::cos(mode * std::numbers::pi * x); });
    return (mode == 0 ? 1. : 2.) * mean / std::numbers::pi;
  };
  problem.below = [emission, emitted = std::map<double, double>{}](double mu, double) mutable {
    const auto [known, is_new] = emitted.try_emplace(mu, emission);
    if (is_new)
      known->second *=
          1. - 2. * meanByGauss([&](double mu_in) {
                 return mu_in * meanByGauss([&](double x) { return hapke(mu, mu_in, std::numbers::pi * x); });
               });
    return known->second;
  };
}

pp::Problem problemOf(const json& given) {
  double above = given.at("fisot");
  if (given.contains("ttemp")) above += planck(given["wavenumbers"], given["ttemp"]);
  pp::Problem problem{.above = above, .below = given.at("fluor").get<double>()};
  for (std::size_t i = 0; i < given.at("dtauc").size(); ++i) {
    const PhaseFunction phase = given.contains("hg") ? PhaseFunction::henyeyGreenstein(given["hg"].at(i))
                                                     : PhaseFunction::fromMoments(given.at("pmom").at(i));
    problem.layers.push_back({.thickness = given["dtauc"][i], .medium = Particles{given.at("ssalb").at(i), phase}});
    if (!given.contains("temper")) continue;
    problem.layers.back().emission_top = planck(given["wavenumbers"], given["temper"].at(i));
    problem.layers.back().emission_bottom = planck(given["wavenumbers"], given["temper"].at(i + 1));
  }
  if (given.at("fbeam") > 0.)
    problem.beam = pp::Beam{.mu0 = given.at("umu0"),
                            .azimuth = given.at("phi0").get<double>() * std::numbers::pi / 180.,
                            .irradiance = given["fbeam"]};
  const double emission = given.contains("btemp") ? planck(given["wavenumbers"], given["btemp"]) : 0.;
  problem.ground = {.albedo = given.at("albedo"), .emission = emission};
  if (given.contains("hapke")) {
    problem.ground = {};
    setHapkeGround(problem, given.at("nstr"), emission);
  }
  return problem;
}

// What a depth absorbs less what it emits: (1 - omega) 4 pi (J - B) of the layer above it.
double divergence(const pp::Problem& problem, double depth, double mean_intensity) {
  std::size_t i = 0;
  double top = 0.;
  while (i + 1 < problem.layers.size() && depth > top + problem.layers[i].thickness)
    top += problem.layers[i++].thickness;
  const pp::Layer& layer = problem.layers[i];
  const double share = (depth - top) / layer.thickness;
  const double emitted = layer.emission_top + share * (layer.emission_bottom - layer.emission_top);
  return (1. - std::get<Particles>(layer.medium).albedo) * 4. * std::numbers::pi * (mean_intensity - emitted);
}

// Where DISORT is given N + 1 moments of Henyey and Greenstein, it takes their sum, negative in places, for the whole
// phase function. What its first scattering by them has beyond that of the moments scaled by f = g^N:
// omega f / (1 - omega f) times the sum of (2 l + 1) P_l, l = 0 .. N, where the beam meets the view.
double addedByMoments(const json& given, double depth, double mu, double phi) {
  if (!given.contains("hg") || given.at("fbeam") == 0.) return 0.;
  const int streams = given.at("nstr");
  const double mu0 = given.at("umu0"), sines = std::sqrt((1. - mu0 * mu0) * (1. - mu * mu));
  double sum = 0.;
  for (int l = 0; l <= streams; ++l)
    sum += (2. * l + 1.) * boost::math::legendre_p(l, mu0 * mu + sines * std::cos(phi));
  double top = 0., scaled_top = 0., to_level = 0., result = 0.;
  struct Part {
    double from, to, peak;  // scaled depths, omega f / (1 - omega f)
  };
  std::vector<Part> parts;
  for (std::size_t i = 0; i < given.at("dtauc").size(); ++i) {
    const double g = given["hg"].at(i), w = given["dtauc"].at(i);
    const double peak = given.at("ssalb").at(i).get<double>() * std::pow(g, streams);
    const double inside = std::clamp(depth - top, 0., w);
    to_level += (1. - peak) * inside;
    const double from = mu > 0. ? 0. : inside, to = mu > 0. ? inside : w;
    parts.push_back({scaled_top + (1. - peak) * from, scaled_top + (1. - peak) * to, peak / (1. - peak)});
    scaled_top += (1. - peak) * w;
    top += w;
  }
  for (const auto& [from, to, peak] : parts)
    if (to > from)
      result += peak * boost::math::quadrature::gauss_kronrod<double, 31>::integrate(
                           [&](double z) { return std::exp(-z / mu0 - (to_level - z) / mu) / std::abs(mu); }, from, to);
  return given.at("fbeam").get<double>() / (4. * std::numbers::pi) * sum * result;
}

// The values are DISORT's own for `nstr` directions, 1e-3 and more from the limit of many: so ours are taken for as
// many, by the same delta-M and corrections. Six digits are printed; what is printed as 0 is below 1e-12 of the light
// that arrives. DISORT's series for Planck's function is up to 5e-7 off in 7a.
void expectPrinted(double value, double printed, double planck_error, const std::string& what) {
  const double half_unit = printed == 0. ? 1e-12 : 0.5 * std::pow(10., std::floor(std::log10(std::abs(printed))) - 5.);
  EXPECT_NEAR(value, printed, half_unit * (1. + 1e-6) + planck_error * std::abs(printed)) << what;
}

class PublishedProblem : public testing::TestWithParam<std::string> {};

TEST_P(PublishedProblem, IsMetToThePrintedDigits) {
  const json given = problems().at(GetParam());
  const pp::Problem problem = problemOf(given);
  pp::Solver solver({.streams = given.at("nstr"), .corrections = !given.contains("hg"), .collocation = true});
  solver.solve(problem);
  const double planck_error = given.contains("temper") ? 5e-7 : 0.;
  const std::vector<double> depths = given.at("utau");
  for (std::size_t i = 0; i < depths.size(); ++i) {
    const std::string where = " at depth " + std::to_string(depths[i]);
    const pp::Fluxes fluxes = solver.fluxes(depths[i]);
    expectPrinted(fluxes.direct, given.at("expected_rfldir").at(i), planck_error, "direct" + where);
    expectPrinted(fluxes.down, given.at("expected_rfldn").at(i), planck_error, "down" + where);
    expectPrinted(fluxes.up, given.at("expected_flup").at(i), planck_error, "up" + where);
    expectPrinted(divergence(problem, depths[i], fluxes.mean_intensity), given.at("expected_dfdt").at(i), planck_error,
                  "flux divergence" + where);
  }
  // Theirs: mu > 0 is upward, azimuths in degrees, and the azimuth is the slowest index.
  std::vector<double> mus = given.at("umu"), phis = given.at("phi");
  for (double& mu : mus) mu = -mu;
  for (double& phi : phis) phi *= std::numbers::pi / 180.;
  std::vector<double> radiances(depths.size() * mus.size() * phis.size());
  solver.radiances(depths, mus, phis, radiances);
  for (std::size_t d = 0; d < depths.size(); ++d)
    for (std::size_t i = 0; i < mus.size(); ++i)
      for (std::size_t j = 0; j < phis.size(); ++j)
        expectPrinted(
            radiances[(d * mus.size() + i) * phis.size() + j] + addedByMoments(given, depths[d], mus[i], phis[j]),
            given.at("expected_uu_iu_lu_j").at((j * depths.size() + d) * mus.size() + i), planck_error,
            "radiance at depth " + std::to_string(depths[d]) + " mu " + std::to_string(mus[i]) + " phi " +
                std::to_string(phis[j]));
}

std::vector<std::string> names() {
  std::vector<std::string> result;
  const json all = problems();
  for (const auto& [name, given] : all.items()) result.push_back(name);
  return result;
}

INSTANTIATE_TEST_SUITE_P(Disort, PublishedProblem, testing::ValuesIn(names()),
                         [](const testing::TestParamInfo<std::string>& problem) { return problem.param; });

}  // namespace
