// Check that the exact solver gives the published solutions that DISORT is tested by.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

#include "pp_solver/solver.hpp"

namespace {

using namespace sunfleck;
using nlohmann::json;

const std::filesystem::path kProblems =
    std::filesystem::path(SUNFLECK_SOURCE_DIR) / "../shared/reference/disort_tests.json";

// Two of disort_tests.json: van de Hulst 1980, Table 12 (lit by a sky of radiance 1); Sweigart 1970, Table 1.
constexpr const char* kCopiedProblems = R"({"cases": {
"1c": {"nstr": 16, "fbeam": 0, "umu0": 0.1, "phi0": 0, "fisot": 1, "fluor": 0, "albedo": 0, "dtauc": [0.03125],
  "ssalb": [0.99], "utau": [0, 0.03125], "umu": [-1, -0.5, -0.1, 0.1, 0.5, 1], "phi": [0], "pmom": [[1, 0, 0]],
  "expected_rfldir": [0, 0], "expected_rfldn": [3.14159, 3.04897], "expected_flup": [0.0906556, 0],
  "expected_dfdt": [0.066687, 0.0588936],
  "expected_uu_iu_lu_j": [1, 1, 1, 0.133177, 0.0299879, 0.0152233, 0.984447, 0.969363, 0.863946, 0, 0, 0]},
"2a": {"nstr": 16, "fbeam": 3.141592654, "umu0": 0.080442, "phi0": 0, "fisot": 0, "fluor": 0, "albedo": 0,
  "dtauc": [0.2], "ssalb": [0.5], "utau": [0, 0.2], "umu": [-0.981986, -0.538263, -0.018014, 0.018014, 0.538263, 0.981986],
  "phi": [0], "pmom": [[1, 0, 0.1]], "expected_rfldir": [0.252716, 0.0210311], "expected_rfldn": [0, 0.0441791],
  "expected_flup": [0.0535063, 0], "expected_dfdt": [1.6657, 0.189848],
  "expected_uu_iu_lu_j": [0, 0, 0, 0.161796, 0.0211501, 0.00786713, 0.00771897, 0.0200778, 0.0257685, 0, 0, 0]}}})";

json problems() {
  std::ifstream file(kProblems);
  return (file ? json::parse(file) : json::parse(kCopiedProblems)).at("cases");
}

pp::Problem problemOf(const json& given) {
  pp::Problem problem{.above = given.at("fisot").get<double>(), .below = given.at("fluor").get<double>()};
  for (std::size_t i = 0; i < given.at("dtauc").size(); ++i)
    problem.layers.push_back(
        {.thickness = given["dtauc"][i],
         .medium = Particles{given.at("ssalb").at(i), PhaseFunction::fromMoments(given.at("pmom").at(i))}});
  if (given.at("fbeam") > 0.)
    problem.beam = pp::Beam{.mu0 = given.at("umu0"),
                            .azimuth = given.at("phi0").get<double>() * std::numbers::pi / 180.,
                            .irradiance = given["fbeam"]};
  problem.ground.albedo = given.at("albedo");
  return problem;
}

// The values are DISORT's own for `nstr` directions, 1e-3 and more from the limit of many: so ours are taken for as
// many, by the same delta-M and corrections. Six digits are printed; what is printed as 0 is below 1e-12 of the light
// that arrives.
void expectPrinted(double value, double printed, const std::string& what) {
  const double half_unit = printed == 0. ? 1e-12 : 0.5 * std::pow(10., std::floor(std::log10(std::abs(printed))) - 5.);
  EXPECT_NEAR(value, printed, half_unit * (1. + 1e-6)) << what;
}

class PublishedProblem : public testing::TestWithParam<std::string> {};

TEST_P(PublishedProblem, IsMetToThePrintedDigits) {
  const json given = problems().at(GetParam());
  const double omega = given.at("ssalb").at(0);
  pp::Solver solver({.streams = given.at("nstr"), .collocation = true});
  solver.solve(problemOf(given));
  const std::vector<double> depths = given.at("utau");
  for (std::size_t i = 0; i < depths.size(); ++i) {
    const std::string where = " at depth " + std::to_string(depths[i]);
    const pp::Fluxes fluxes = solver.fluxes(depths[i]);
    expectPrinted(fluxes.direct, given.at("expected_rfldir").at(i), "direct" + where);
    expectPrinted(fluxes.down, given.at("expected_rfldn").at(i), "down" + where);
    expectPrinted(fluxes.up, given.at("expected_flup").at(i), "up" + where);
    const double divergence = (1. - omega) * 4. * std::numbers::pi * fluxes.mean_intensity;
    expectPrinted(divergence, given.at("expected_dfdt").at(i), "flux divergence" + where);
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
        expectPrinted(radiances[(d * mus.size() + i) * phis.size() + j],
                      given.at("expected_uu_iu_lu_j").at((j * depths.size() + d) * mus.size() + i),
                      "radiance at depth " + std::to_string(depths[d]) + " mu " + std::to_string(mus[i]) + " phi " +
                          std::to_string(phis[j]));
}

std::vector<std::string> names() {
  std::vector<std::string> result;
  const json all = problems();
  for (const auto& [name, given] : all.items()) result.push_back(name);
  return result;
}

// "Test Case No. 4c, Haze-L ..." becomes 4c.
std::string shortName(const testing::TestParamInfo<std::string>& info) {
  const auto digit = info.param.find_first_of("123456789");
  return info.param.substr(digit, 2);
}

INSTANTIATE_TEST_SUITE_P(Disort, PublishedProblem, testing::ValuesIn(names()), shortName);

}  // namespace
