#include "render/compare/slab_tables.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

// Table 1 of the paper by our closed forms.
namespace {

using namespace sunfleck;

// (R9) Check the closed forms for one asymmetry in a slab of thickness 10: refined SPP within 0.15 points of another
// study's figures for the five albedos, which has other directions and depths; the two-stream default in total at most
// a fortieth of refined SPP's error, four streams at most a two-hundredth, and less in every cell.
void checkTable1(double asymmetry, const std::array<double, 5>& refined_percent) {
  const std::vector<const SlabModel*> models{findSlabModel("sppr"), findSlabModel("nstream"), findSlabModel("best")};
  const std::array albedos{0.5, 0.7, 0.9, 0.95, 0.99};
  std::array<double, 3> squares{};
  for (std::size_t a = 0; a < albedos.size(); ++a) {
    const auto errors = slabRadianceErrors(models, asymmetry, albedos[a], 10., 16);
    EXPECT_NEAR(100. * errors[0], refined_percent[a], 0.15) << "albedo " << albedos[a];
    EXPECT_LT(errors[2], errors[1]) << "albedo " << albedos[a];
    for (std::size_t m = 0; m < 3; ++m) squares[m] += errors[m] * errors[m];
  }
  EXPECT_LT(std::sqrt(squares[1] / squares[0]), 1. / 40.);
  EXPECT_LT(std::sqrt(squares[2] / squares[0]), 1. / 200.);
}
TEST(R9_SlabRadianceErrors, OfClosedFormsForIsotropicScattering) {
  checkTable1(0., {0.1, 0.3, 1.3, 2.2, 5.1});
}
TEST(R9_SlabRadianceErrors, OfClosedFormsForForwardScattering) {
  checkTable1(0.5, {0.1, 0.4, 1.4, 2.5, 5.6});
}
TEST(R9_SlabRadianceErrors, OfClosedFormsForBackwardScattering) {
  checkTable1(-0.5, {0.1, 0.3, 1.1, 1.9, 4.7});
}

}  // namespace
