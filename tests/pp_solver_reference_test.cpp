// Check that the exact solver gives the values on which other codes for homogeneous slabs agree.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "chandrasekhar_h.hpp"
#include "pp_solver/solver.hpp"

namespace {

using namespace sunfleck;

const std::filesystem::path kRows =
    std::filesystem::path(SUNFLECK_SOURCE_DIR) / "../shared/reference/slab_reference.csv";

// Some of slab_reference.csv: values on which nanodisort 0.3.0, disortpp 1.2.1, PythonicDISORT 1.8 and an
// adding-doubling code agree; thickness inf is by Chandrasekhar's H. The beam has irradiance pi; R and T are shares; T
// is with the beam, downward radiances without; up and dn are the way the light travels, mid is half the depth, phi 0
// is forward.
constexpr const char* kCopiedRows = R"(g,omega,tau,mu0,quantity,value,uncertainty
0.0,0.5,0.1,1.0,R,0.0217329876768162,1.1e-13
0.0,0.99,10.0,0.5,I_up_mid(mu=0.5;phi=0),0.125115066492627,6.4e-12
0.0,1.0,inf,1.0,H(mu0),2.9078105290787,1.0e-11
0.0,1.0,inf,0.1,I_up_top(mu=0.5;phi=0),0.104610020391645,1.0e-11
0.0,0.999999,inf,0.5,R,0.997988963309954,3.0e-12
0.5,0.99,10.0,0.5,I_dn_mid(mu=1.0;phi=0),0.225659629842911,4.8e-11
0.5,0.5,10.0,0.1,I_up_top(mu=1.0;phi=0),0.007864152942402,1.2e-12
-0.5,1.0,10000.0,0.5,T,7.63790255150295e-05,1.0e-13
-0.5,0.99,0.1,0.1,I_up_top(mu=0.1;phi=0),0.0831457288135535,1.4e-10
0.85,0.99,10.0,0.1,T,0.164730549858046,6.4e-12
0.85,1.0,1000000.0,0.1,R,0.999995846042693,8.1e-10
0.85,0.5,1.0,1.0,I_dn_mid(mu=1.0;phi=0),3.22894430594804,6.4e-07
)";

using Slab = std::tuple<double, double, double, double>;  // g, omega, tau, mu0

struct Row {
  std::string quantity;
  double value, uncertainty;
};

std::map<Slab, std::vector<Row>> rowsBySlab() {
  std::ifstream file(kRows);
  std::istringstream copied(kCopiedRows);
  std::istream& rows = file ? static_cast<std::istream&>(file) : copied;
  std::map<Slab, std::vector<Row>> result;
  std::string line;
  std::getline(rows, line);
  while (std::getline(rows, line)) {
    std::istringstream fields(line);
    std::array<std::string, 7> field;
    for (std::string& f : field) std::getline(fields, f, ',');
    result[{std::stod(field[0]), std::stod(field[1]), std::stod(field[2]), std::stod(field[3])}].push_back(
        {field[4], std::stod(field[5]), std::stod(field[6])});
  }
  return result;
}

constexpr std::array kCosines{-1., -0.5, -0.1, 0.1, 0.5, 1.};

// "I_dn_mid(mu=0.5;phi=0)" among radiances at the top, in the middle and at the bottom (only the top of an infinite
// slab).
double radianceNamed(const std::string& quantity, const std::vector<double>& radiances) {
  const std::size_t level = quantity.find("top") != std::string::npos   ? 0
                            : quantity.find("mid") != std::string::npos ? 1
                                                                        : 2;
  const double cosine = std::stod(quantity.substr(quantity.find("mu=") + 3));
  const double signed_cosine = quantity.starts_with("I_up") ? -cosine : cosine;
  const auto found = std::ranges::find(kCosines, signed_cosine);
  return radiances.at(level * kCosines.size() + static_cast<std::size_t>(found - kCosines.begin()));
}

class PlaneParallelReference : public testing::TestWithParam<double> {};

// Check every row of one g. 128 directions, as the codes that made them had: then the series of the phase function is
// cut where g = .85 has fallen to 1e-9. Each row tells its own uncertainty; 2e-9 of the value is what may be added.
TEST_P(PlaneParallelReference, IsMetByEveryRow) {
  pp::Solver solver({.streams = 128});
  int rows = 0;
  for (const auto& [slab, expected] : rowsBySlab()) {
    const auto [g, omega, tau, mu0] = slab;
    if (g != GetParam()) continue;
    const bool infinite = std::isinf(tau);
    SCOPED_TRACE(testing::Message() << "g " << g << " omega " << omega << " tau " << tau << " mu0 " << mu0);
    solver.solve({.layers = {{.thickness = tau, .medium = Particles{omega, PhaseFunction::henyeyGreenstein(g)}}},
                  .beam = pp::Beam{.mu0 = mu0, .irradiance = std::numbers::pi}});
    std::vector<double> depths{0.}, radiances;
    if (!infinite) depths = {0., 0.5 * tau, tau};
    if (std::ranges::any_of(expected, [](const Row& row) { return row.quantity.starts_with("I_"); })) {
      radiances.resize(depths.size() * kCosines.size());
      solver.radiances(depths, kCosines, std::array{0.}, radiances);
    }
    for (const Row& row : expected) {
      double value = 0.;
      if (row.quantity == "R")
        value = solver.reflectance();
      else if (row.quantity == "T")
        value = solver.transmittance();
      else if (row.quantity == "H(mu0)")
        value = witness::ChandrasekharH(omega)(mu0);
      else
        value = radianceNamed(row.quantity, radiances);
      // One row is off by more than it tells, where 3e-12 of the light is left: doubling with 48 to 96 nodes and the
      // solver with 32 to 256 directions agree to 5e-8 on 2.959535e-12, 1.1e-6 below it.
      const bool known_wrong = omega == 0.999999 && tau == 1e4 && row.quantity == "T";
      const double allowed = known_wrong ? 1.2e-6 : 2e-9;
      EXPECT_NEAR(value, row.value, row.uncertainty + allowed * std::abs(row.value)) << row.quantity;
      ++rows;
    }
  }
  EXPECT_GT(rows, 0);
}

INSTANTIATE_TEST_SUITE_P(Slabs, PlaneParallelReference, testing::Values(0., 0.5, -0.5, 0.85),
                         [](const testing::TestParamInfo<double>& slab) { return "G" + std::to_string(slab.index); });

}  // namespace
