// Leaves whose places and sides differ: tissue by its thickness, textures, and what is behind measured maps.
#include "leaves/leaf_textures.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/require.hpp"
#include "leaves/leaf_map_fit.hpp"
#include "leaves/slab_leaf.hpp"
#include "leaves/tissue_by_thickness.hpp"

namespace sunfleck {
namespace {

LeafByTissue oakTissue() {
  return {.absorption = {1.5f, 0.4f, 5.f}, .scattering = {11.f, 10.f, 9.f}, .thickness = 0.2};
}

std::shared_ptr<LeafTexture> textureOf(int width, int height) {
  auto texture = std::make_shared<LeafTexture>();
  texture->width = width;
  texture->height = height;
  const auto places = static_cast<std::size_t>(width * height);
  texture->colour.assign(places, glm::vec3(1.f));
  texture->alpha.assign(places, 0.5f);
  return texture;
}

// Check the table against the exact solution between its rows, for leaves and for the ends of all ranges.
TEST(L10_TissueByThickness, IsTheExactSolution) {
  struct Range {
    glm::dvec3 absorption, scattering;
    double thinnest, thickest, tolerance;
  };
  // 1e-6: leaves; 2e-6 next to no thickness, where slopes of what thin slabs scatter grow without end.
  for (const Range& of : {Range{{1.5, 0.4, 5.}, {11., 10., 9.}, 0.1, 0.3, 1e-6},
                          {{0.01, 50., 0.}, {20., 0.01, 30.}, 0., 1., 2e-6},
                          {{0., 1e3, 1e6}, {1e6, 10., 1e6}, 0., 1000., 2e-6}}) {
    const TissueByThickness table(of.absorption, of.scattering, of.thinnest, of.thickest);
    for (int i = 0; i <= 60; ++i) {
      const double x = i / 60., thickness = of.thinnest + (of.thickest - of.thinnest) * x * x * x * x * x;
      const TissueBands found = table.at(thickness);
      for (std::size_t band = 0; band < kBands; ++band) {
        const int b = static_cast<int>(band);
        const LeafSides exact =
            slabLeaf({.absorption = of.absorption[b], .scattering = of.scattering[b], .thickness = thickness}).sides;
        EXPECT_NEAR(found.reflectance[band], exact.reflectance, of.tolerance) << thickness << " " << band;
        EXPECT_NEAR(found.transmittance[band], exact.transmittance, of.tolerance) << thickness << " " << band;
        EXPECT_LE(found.reflectance[band] + found.transmittance[band], 1.);
      }
    }
  }
  EXPECT_THROW(TissueByThickness(glm::dvec3(-1.), glm::dvec3(1.), 0., 1.), InvalidInput);
  EXPECT_THROW(TissueByThickness(glm::dvec3(1.), glm::dvec3(1.), 0., std::nan("")), InvalidInput);
}

// Check that textures that tell nothing leave the leaf as it is, and that what differs is where it is told.
TEST(L11_LeafMaps, FollowTheTextures) {
  const LeafDescription leaf = oakTissue();
  const BandOptics even = bandOptics(leaf, {}, {});
  EXPECT_EQ(leafMaps(leaf, even, {}), nullptr);
  auto upper = textureOf(3, 2), lower = textureOf(3, 2);
  upper->alpha[1] = 1.f;
  upper->colour[2] = {0.5f, 1.f, 0.f};
  lower->alpha[1] = 0.75f;
  lower->colour[2] = glm::vec3(0.25f);
  LeafTextures textures{
      .upper = {.detail = upper}, .lower = {.detail = lower}, .albedo = {1.f, 1.f, 2.f}, .relief = 0.1};
  const auto maps = leafMaps(leaf, even, textures);
  ASSERT_TRUE(maps);
  validate(*maps, "maps");
  ASSERT_EQ(maps->places.size(), 6u);
  for (std::size_t band = 0; band < kBands; ++band) {
    const int b = static_cast<int>(band);
    const float gamma = textures.albedo[b];
    // 1e-6: what the table is off by; floats.
    EXPECT_NEAR(maps->places[0].transmittance[b], even[band].transmittance, 2e-6f);
    EXPECT_NEAR(maps->places[0].faces[0].reflectance[b], gamma * even[band].reflectance, 2e-6f);
    EXPECT_NEAR(maps->places[2].faces[0].reflectance[b], gamma * upper->colour[2][b] * even[band].reflectance, 2e-6f);
    EXPECT_NEAR(maps->places[2].faces[1].reflectance[b], gamma * 0.25f * even[band].reflectance, 2e-6f);
    // Thickness: the mean of 0.3 and 0.25 mm.
    const LeafByTissue tissue = oakTissue();
    const LeafSides thick = slabLeaf({.absorption = double{tissue.absorption[b]},
                                      .scattering = double{tissue.scattering[b]},
                                      .thickness = 0.275})
                                .sides;
    EXPECT_NEAR(double{maps->places[1].transmittance[b]}, thick.transmittance, 2e-6);
    EXPECT_NEAR(double{maps->places[1].faces[0].reflectance[b]}, double{gamma} * thick.reflectance, 2e-6);
  }
  // Of a leaf told by numbers delta counts for nothing; the lower side shows the upper's image unless it has its own.
  textures.lower = {};
  const auto plain = leafMaps(LeafByNumbers{}, even, textures);
  EXPECT_EQ(plain->places[1].transmittance, plain->places[0].transmittance);
  EXPECT_EQ(plain->places[2].faces[1], plain->places[2].faces[0]);
}

// Check that no place sends back and on more than arrives, and that nothing is below no thickness.
TEST(L11_LeafMaps, ConserveEnergy) {
  auto upper = textureOf(64, 64);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> any(0.f, 1.f);
  for (std::size_t i = 0; i < upper->colour.size(); ++i) {
    upper->colour[i] = {any(random), any(random), any(random)};
    upper->alpha[i] = any(random);
  }
  const LeafDescription leaf = oakTissue();
  const auto maps =
      leafMaps(leaf, bandOptics(leaf, {}, {}), {.upper = {.detail = upper}, .albedo = glm::vec3(100.f), .relief = 5.});
  std::size_t capped = 0;
  for (const LeafPlace& place : maps->places)
    for (int band = 0; band < kBands; ++band) {
      const float all = place.faces[0].reflectance[band] + place.transmittance[band];
      EXPECT_LE(all, 1.f + 1e-7f);  // rounding of the sum
      capped += all > 0.999999f ? 1 : 0;
    }
  EXPECT_GT(capped, 1000u);
  validate(*maps, "maps");
}

// Check gloss and its roughness: at most eight, exact where there are no more, else near to each place's.
TEST(L11_LeafMaps, RoundRoughness) {
  auto gloss = textureOf(40, 25);
  for (std::size_t i = 0; i < gloss->alpha.size(); ++i) {
    gloss->alpha[i] = static_cast<float>(i) / 999.f;
    gloss->colour[i] = glm::vec3(0.25f);
  }
  const BandOptics even{};
  const auto fine = leafMaps(LeafByNumbers{}, even, {.upper = {.gloss = gloss}});
  EXPECT_EQ(fine->roughnesses.size(), kMostRoughnesses);
  for (std::size_t i = 0; i < gloss->alpha.size(); ++i) {
    const LeafFace& face = fine->places[i].faces[0];
    EXPECT_EQ(face.gloss, glm::vec3(0.25f));
    // Eight levels over 0.05 to 1, each near the middle of its share: half of 0.95 / 8, and a quarter of it more for
    // those at the ends, where all below 0.05 count as 0.05.
    EXPECT_NEAR(fine->roughnesses[face.roughness], std::max(gloss->alpha[i], 0.05f), 0.075f) << i;
  }
  for (std::size_t i = 0; i < gloss->alpha.size(); ++i) gloss->alpha[i] = i % 2 ? 0.2f : 0.7f;
  const auto two = leafMaps(LeafByNumbers{}, even, {.upper = {.gloss = gloss}});
  for (std::size_t i = 0; i < gloss->alpha.size(); ++i)
    EXPECT_EQ(two->roughnesses[two->places[i].faces[1].roughness], gloss->alpha[i]);
}

// Check a lower side by numbers, on images of one place.
TEST(L11_LeafMaps, TakeALowerSideByNumbers) {
  BandOptics even;
  even.fill({.reflectance = 0.3f, .transmittance = 0.4f, .gloss = 0.1f, .gloss_roughness = 0.2f});
  const LeafTextures textures{
      .underside = {.reflectance = glm::vec3(0.5f, 0.6f, 0.7f), .gloss = glm::vec3(0.f), .gloss_roughness = 0.5f}};
  const auto maps = leafMaps(LeafByNumbers{}, even, textures);
  ASSERT_EQ(maps->places.size(), 1u);
  const LeafPlace& place = maps->places[0];
  EXPECT_EQ(place.transmittance, glm::vec3(0.4f));
  EXPECT_EQ(place.faces[0].reflectance, glm::vec3(0.3f));
  EXPECT_EQ(place.faces[1].reflectance, glm::vec3(0.5f, 0.6f, 1.f - 0.4f));
  EXPECT_EQ(place.faces[1].gloss, glm::vec3(0.f));
  EXPECT_EQ(maps->roughnesses[place.faces[0].roughness], 0.2f);
  EXPECT_EQ(maps->roughnesses[place.faces[1].roughness], 0.5f);
}

TEST(LeafTextures, RefuseWhatDoesNotFit) {
  const auto refusal = [](const LeafTextures& textures) {
    try {
      validate(textures, "leaf");
    } catch (const InvalidInput& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(refusal({.upper = {.detail = textureOf(2, 2), .gloss = textureOf(2, 3)}}).find("must be of one size"),
            std::string::npos);
  EXPECT_NE(refusal({.lower = {.detail = textureOf(2, 2)}, .underside = {.gloss_roughness = 0.5f}}).find("one of them"),
            std::string::npos);
  EXPECT_NE(refusal({.underside = {.reflectance = glm::vec3(1.5f)}}).find("must be in [0, 1]"), std::string::npos);
  EXPECT_NE(refusal({.albedo = glm::vec3(std::nanf(""))}).find("must be in [0, 100]"), std::string::npos);
  EXPECT_NE(refusal({.relief = -1.}).find("must be in [0, 1000] mm"), std::string::npos);
  auto texture = textureOf(2, 2);
  texture->alpha[3] = std::nanf("");
  EXPECT_THROW(validate(*texture, 1.f, "t"), InvalidInput);
  texture->alpha.pop_back();
  EXPECT_THROW(validate(*texture, 1.f, "t"), InvalidInput);
}

// A leaf with veins: gamma of mean 1, delta of mean 0, and what is measured of it, with noise.
struct KnownLeaf {
  std::vector<glm::vec3> gamma;
  std::vector<double> delta;
  MeasuredLeafMaps measured;
};
KnownLeaf knownLeaf(int width, int height, double noise) {
  KnownLeaf leaf;
  const LeafByTissue tissue = oakTissue();
  glm::dvec3 gamma_sum(0.);
  double delta_sum = 0.;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double u = (x + 0.5) / width, v = (y + 0.5) / height;
      leaf.gamma.push_back(glm::vec3(1.f + 0.3f * static_cast<float>(std::sin(23. * u)), 1.f,
                                     1.f + 0.2f * static_cast<float>(std::cos(17. * v + 3. * u))));
      leaf.delta.push_back(0.06 * std::sin(31. * v) + 0.04 * std::sin(11. * u + 5. * v));
      gamma_sum += glm::dvec3(leaf.gamma.back());
      delta_sum += leaf.delta.back();
    }
  const auto places = static_cast<double>(leaf.delta.size());
  const TissueByThickness table(glm::dvec3(tissue.absorption), glm::dvec3(tissue.scattering), 0., 0.8);
  std::mt19937 random(7);
  std::normal_distribution<double> error(0., 1.);
  for (std::size_t i = 0; i < leaf.delta.size(); ++i) {
    leaf.gamma[i] = glm::vec3(glm::dvec3(leaf.gamma[i]) * places / gamma_sum);
    leaf.delta[i] -= delta_sum / places;
    const TissueBands even = table.at(tissue.thickness + leaf.delta[i]);
    glm::vec3 r, t;
    for (int band = 0; band < kBands; ++band) {
      const auto b = static_cast<std::size_t>(band);
      const auto share = [&](double value) {
        return static_cast<float>(std::clamp(value + noise * error(random), 0., 1.));
      };
      r[band] = share(double{leaf.gamma[i][band]} * even.reflectance[b]);
      t[band] = share(even.transmittance[b]);
    }
    leaf.measured.reflectance.push_back(r);
    leaf.measured.transmittance.push_back(t);
  }
  return leaf;
}

// Check that maps of known tissue lead back to it, with and without noise.
TEST(L12_FitLeafMaps, FindsTheLeaf) {
  const LeafByTissue truth = oakTissue();
  for (const double noise : {0., 0.005}) {
    const KnownLeaf leaf = knownLeaf(160, 120, noise);
    const LeafMapFit fit = fitLeafMaps(leaf.measured, truth.thickness);
    EXPECT_TRUE(fit.converged);
    EXPECT_EQ(fit.at_limit, 0u);
    // Without noise, what means that moved by less than 1e-6 leave. With it, delta is off by some 0.005 / (dT / dh = 2
    // to 3 / mm) and its square bends means by some 1e-3.
    const double constants = noise > 0. ? 5e-3 : 1e-3;
    for (int band = 0; band < kBands; ++band) {
      EXPECT_NEAR(fit.tissue.absorption[band] / truth.absorption[band], 1., constants) << band;
      EXPECT_NEAR(fit.tissue.scattering[band] / truth.scattering[band], 1., constants) << band;
      EXPECT_LT(fit.rms_transmittance[band], noise > 0. ? 0.006 : 1e-5) << band;
    }
    double off_delta = 0., off_gamma = 0.;
    for (std::size_t i = 0; i < leaf.delta.size(); ++i) {
      off_delta += std::pow(double{fit.delta[i]} - leaf.delta[i], 2);
      off_gamma += std::pow(double{fit.gamma[i].y - leaf.gamma[i].y}, 2);
    }
    const auto places = static_cast<double>(leaf.delta.size());
    EXPECT_LT(std::sqrt(off_delta / places), noise > 0. ? 0.004 : 1e-4);  // [mm]
    EXPECT_LT(std::sqrt(off_gamma / places), noise > 0. ? 0.025 : 1e-3);  // 0.005 of 0.4, and through delta
  }
}

// Check that the maps that were found do again what was measured.
TEST(L12_FitLeafMaps, DoesAgainWhatWasMeasured) {
  const KnownLeaf leaf = knownLeaf(96, 64, 0.003);
  MeasuredLeafMaps measured = leaf.measured;
  for (const glm::vec3& r : measured.reflectance) measured.lower_reflectance.push_back(0.7f * r);
  measured.on_leaf.assign(measured.reflectance.size(), true);
  measured.on_leaf[5] = false;
  measured.reflectance[5] = measured.transmittance[5] = glm::vec3(1.f);
  const LeafMapFit fit = fitLeafMaps(measured, 0.2);
  EXPECT_EQ(fit.places, measured.reflectance.size() - 1);
  EXPECT_EQ(fit.gamma[5], glm::vec3(1.f));
  EXPECT_EQ(fit.delta[5], 0.f);
  auto upper = textureOf(96, 64), lower = textureOf(96, 64);
  upper->colour = fit.gamma;
  lower->colour = fit.lower_gamma;
  for (std::size_t i = 0; i < fit.delta.size(); ++i)
    upper->alpha[i] = lower->alpha[i] = 0.5f + 0.5f * fit.delta[i] / 0.6f;
  const LeafDescription found = fit.tissue;
  const auto maps = leafMaps(found, bandOptics(found, {}, {}),
                             {.upper = {.detail = upper}, .lower = {.detail = lower}, .relief = 0.6});
  glm::dvec3 squares(0.);
  for (std::size_t i = 0; i < maps->places.size(); ++i) {
    if (i == 5) continue;
    for (int band = 0; band < kBands; ++band) {
      // Reflectance is gamma's to the rounding of alpha.
      EXPECT_NEAR(maps->places[i].faces[0].reflectance[band], measured.reflectance[i][band], 5e-6f) << i;
      EXPECT_NEAR(maps->places[i].faces[1].reflectance[band], measured.lower_reflectance[i][band], 5e-6f) << i;
      squares[band] += std::pow(double{maps->places[i].transmittance[band] - measured.transmittance[i][band]}, 2);
    }
  }
  for (int band = 0; band < kBands; ++band)
    EXPECT_NEAR(std::sqrt(squares[band] / static_cast<double>(fit.places)), fit.rms_transmittance[band], 1e-5);
}

// Check that it ends when it is told to, in whichever round.
TEST(L12_FitLeafMaps, EndsWhenItIsNotToGoOn) {
  const KnownLeaf leaf = knownLeaf(96, 64, 0.01);
  int asked = 0;
  fitLeafMaps(leaf.measured, 0.2, [&](double done) {
    EXPECT_TRUE(done >= 0. && done < 1.) << done;
    return ++asked > 0;
  });
  ASSERT_GE(asked, 3);
  for (int last = 1; last <= asked; ++last) {
    int now = 0;
    EXPECT_THROW(fitLeafMaps(leaf.measured, 0.2, [&](double) { return ++now < last; }), std::runtime_error);
    EXPECT_EQ(now, last);
  }
}

// Check that one thread and all find the same to the bit.
TEST(L12_FitLeafMaps, IsTheSameForAnyNumberOfThreads) {
  const KnownLeaf leaf = knownLeaf(96, 64, 0.01);
  const LeafMapFit all = fitLeafMaps(leaf.measured, 0.2);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const LeafMapFit alone = fitLeafMaps(leaf.measured, 0.2);
  EXPECT_EQ(alone.tissue, all.tissue);
  EXPECT_EQ(alone.gamma, all.gamma);
  EXPECT_EQ(alone.delta, all.delta);
}

TEST(L12_FitLeafMaps, RefusesWhatIsNoLeaf) {
  const auto fit = [](const glm::vec3& r, const glm::vec3& t, double thickness) {
    return fitLeafMaps({.reflectance = {r}, .transmittance = {t}}, thickness);
  };
  EXPECT_THROW(fit(glm::vec3(0.f), glm::vec3(0.3f), 0.2), InvalidInput);
  EXPECT_THROW(fit(glm::vec3(0.3f), glm::vec3(0.f), 0.2), InvalidInput);
  EXPECT_THROW(fit(glm::vec3(0.3f), glm::vec3(std::nanf("")), 0.2), InvalidInput);
  for (const double thickness : {0., 0.0009, 251., std::nan("")})
    EXPECT_THROW(fit(glm::vec3(0.3f), glm::vec3(0.3f), thickness), InvalidInput) << thickness;
  EXPECT_THROW(fitLeafMaps({}, 0.2), InvalidInput);
  EXPECT_THROW(fitLeafMaps({.reflectance = {glm::vec3(0.3f)}, .transmittance = {}}, 0.2), InvalidInput);
  // One place, and one that reflects and lets through more than arrives: told, not refused.
  EXPECT_NEAR(fit(glm::vec3(0.3f), glm::vec3(0.3f), 0.2).gamma[0].x, 1.f, 1e-5f);
  EXPECT_EQ(fit(glm::vec3(0.7f), glm::vec3(0.6f), 0.2).capped, 1u);
  // Of very different places of the thinnest leaf, too, constants stay in the range that a scene may hold, and of the
  // thickest the thickness of every place.
  const glm::vec3 dark(0.1f), bright(1.f);
  const MeasuredLeafMaps halves{.reflectance = {dark, bright}, .transmittance = {bright, glm::vec3(0.f)}};
  const LeafMapFit thin = fitLeafMaps(halves, 0.001);
  for (int band = 0; band < kBands; ++band) EXPECT_LE(thin.tissue.scattering[band], 1e6f) << band;
  for (const float delta : fitLeafMaps(halves, 250.).delta) EXPECT_LE(std::abs(delta), 1000.f);
}

}  // namespace
}  // namespace sunfleck
