#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>

#include "core/random.hpp"
#include "render/compare/exact_powers.hpp"
#include "spp/stream_slab.hpp"

namespace {
using namespace sunfleck;

TEST(S15_PowerTable, X) {
  for (const LeafOptics leaf : {LeafOptics{.reflectance = .475f, .transmittance = .475f}, LeafOptics{.reflectance = .5f, .transmittance = .5f}, LeafOptics{.reflectance = .1f, .transmittance = .05f}}) {
    const auto t0 = std::chrono::steady_clock::now();
    const auto refined = spp::refinedPowerTable(leaf);
    const auto t1 = std::chrono::steady_clock::now();
    const auto exact = exactPowerTable(leaf);
    const auto t2 = std::chrono::steady_clock::now();
    std::printf("refined %.3f s exact %.3f s\n", std::chrono::duration<double>(t1 - t0).count(), std::chrono::duration<double>(t2 - t1).count());
    const auto constants = spp::nStreamConstants(spp::sphericalLeaves(leaf), 4, 1);
    spp::PowerTable table;
    for (double thickness : spp::tableThicknesses()) {
      if (thickness == 0) { table.nodes.assign(spp::kTableDepths, {0, 0}); continue; }
      spp::StreamSlab<double> slab(constants, 2. * thickness);
      for (double d : spp::tableDepths(thickness)) { auto l = slab.light(2. * std::min(d, 1e6)); table.nodes.push_back({float(l.power_down - l.direct), float(l.power_up)}); }
    }
    for (const float most : {1.f, 8.f, 30.f, 100.f, 1000.f}) {
      Random random(1, 0);
      double worst = 0, worst_exact = 0, worst_refined = 0, rms = 0;
      float wz = 0, ww = 0;
      for (int i = 0; i < 3000; ++i) {
        const float w = most * random.uniform(), z = w * random.uniform();
        spp::StreamSlab<double> slab(constants, 2. * w);
        const auto l = slab.light(2. * z);
        const auto at = table.at(z, w);
        const double e = std::max(std::abs(double{at.down} - (l.power_down - l.direct)), std::abs(double{at.up} - l.power_up));
        rms += e * e;
        if (e > worst) worst = e, wz = z, ww = w;
        const auto x = exact.at(z, w);
        worst_exact = std::max({worst_exact, std::abs(double{x.down} - (l.power_down - l.direct)), std::abs(double{x.up} - l.power_up)});
        const auto r = refined.at(z, w);
        worst_refined = std::max({worst_refined, std::abs(double{r.down} - double{x.down}), std::abs(double{r.up} - double{x.up})});
      }
      std::printf("albedo %.2f w<%g: table of 4 streams off by %.2g at most (z %.3g of %.3g), rms %.2g; exact table - 4 streams %.2g; refined spp - exact %.2g\n", leaf.albedo(), most, worst, wz, ww, std::sqrt(rms / 3000), worst_exact, worst_refined);
    }
  }
}
}  // namespace
