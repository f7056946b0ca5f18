// Check that leaves under a gloss send to the eye what Monte Carlo's leaves do, in direct light and in light from half
// of the sphere, and that all light is counted once.
#include "render/shading/fragment_shading.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "core/directions.hpp"
#include "core/random.hpp"
#include "render/reference/detail/glossy_leaf.hpp"
#include "spp/power_table.hpp"
#include "spp/stream_slab.hpp"

using namespace sunfleck;
using namespace sunfleck::shading;
using glm::dot;

namespace {

constexpr float kTurn = 2.f * std::numbers::pi_v<float>;

// Powers that are the same everywhere in a slab.
spp::PowerTableOf uniformPowers(float down, float up) {
  return [=](const LeafOptics&) {
    spp::PowerTable table;
    table.nodes.assign(std::size_t{spp::kTableDepths} * spp::kTableThicknesses, {down, up});
    return table;
  };
}

ShadingLight sunAlong(const glm::vec3& travel) {
  return {.travel = vec4(travel, 0.f), .irradiance = vec4(1.f)};
}
constexpr glm::vec3 kDown{0.f, 0.f, -1.f};

// A leaf in the light that travels along `travel`, and in a slab about it with such powers.
FragmentShading leafShading(const LeafOptics& leaf, const glm::vec3& travel, float down, float up) {
  TreeKind kind;
  kind.leaf.fill(leaf);
  ShadingData data;
  update(data, Model::pp, std::array{kind}, std::array{sunAlong(travel)}, uniformPowers(down, up));
  return FragmentShading(Model::pp, data);
}

glm::vec3 drawnDirection(Random& random) {
  const float z = 2.f * random.uniform() - 1.f, azimuth = kTurn * random.uniform(), across = std::sqrt(1.f - z * z);
  return {across * std::cos(azimuth), across * std::sin(azimuth), z};
}

// What a leaf of Monte Carlo sends to the eye.
class TracedLeaf {
 public:
  explicit TracedLeaf(const LeafOptics& leaf) : leaf_({TraceLight{.leaf = leaf}}, 0) {}
  // BRDF or BTDF times the cosine of the light [1/sr]
  double sent(const glm::vec3& normal, const glm::vec3& to_eye, const glm::vec3& to_light) const {
    return double{leaf_.sent(normal, -to_eye, to_light)[0]};
  }
  // Of radiance 1 from the half of the sphere about `up`: rings about the mirrored line of sight, close near it.
  double sentFromHalf(const glm::vec3& normal, const glm::vec3& to_eye, const glm::vec3& up, int rings) const {
    const Axes axes = axesAlong(2.f * dot(normal, to_eye) * normal - to_eye);
    double sum = 0.;
    for (int i = 0; i < rings; ++i) {
      const double share = (i + 0.5) / rings, angle = std::numbers::pi * share * share;
      const double ring = std::numbers::pi * 2. * share / rings * std::sin(angle) * 2. * std::numbers::pi / rings;
      for (int j = 0; j < rings; ++j) {
        const double turn = 2. * std::numbers::pi * (j + 0.5) / rings;
        const glm::vec3 light = static_cast<float>(std::cos(angle)) * axes.along +
                                static_cast<float>(std::sin(angle) * std::cos(turn)) * axes.right +
                                static_cast<float>(std::sin(angle) * std::sin(turn)) * axes.up;
        if (dot(light, up) > 0.f) sum += ring * sent(normal, to_eye, light);
      }
    }
    return sum;
  }

 private:
  sunfleck::detail::GlossyLeaf<1> leaf_;
};

struct Seen {
  glm::vec3 normal, to_eye;  // the normal on the eye's side
};
Seen drawnView(Random& random) {
  Seen seen{drawnDirection(random), drawnDirection(random)};
  if (dot(seen.normal, seen.to_eye) < 0.f) seen.normal = -seen.normal;
  return seen;
}

constexpr FragmentLight kFullLight{.foliage = {0.f, 0.f, 1.f}, .thickness = 1.f, .compensation = 1.f};

}  // namespace

// Check light from half of the sphere against the integral of what Monte Carlo's leaves scatter, over 60 lines of sight
// for each roughness. Of radiance 1 the tables may be off by their interpolation: 0.035 was the most of 200 lines, the
// root of the mean square 0.002 to 0.007; the integral by its 160 x 160 directions by 0.002.
TEST(R26_GlossTables, SendLightOfHalfTheSphereAsTracedLeavesDo) {
  for (const float roughness : {0.05f, 0.1f, 0.3f, 0.6f, 1.f}) {
    const LeafOptics leaf{.reflectance = 0.3f, .transmittance = 0.2f, .gloss = 1.f, .gloss_roughness = roughness};
    const TracedLeaf traced(leaf);
    const glm::vec3 travel = sunlight(0.7f, 1.f);
    const FragmentShading shading = leafShading(leaf, travel, kTurn, 0.f);
    Random random(3, 0);
    double squares = 0.;
    constexpr int kViews = 60;
    for (int i = 0; i < kViews; ++i) {
      const auto [normal, to_eye] = drawnView(random);
      const Shaded shaded = shading.shadeByLight(shading.leafSurface(0, {}, 0, 0, normal, to_eye), kFullLight, 0);
      const double expected = traced.sentFromHalf(normal, to_eye, -travel, 160);
      EXPECT_NEAR(shaded.scattered[0], expected, 0.045) << "roughness " << roughness << ", line of sight " << i;
      squares += std::pow(double{shaded.scattered[0]} - expected, 2);
    }
    EXPECT_LT(std::sqrt(squares / kViews), 0.009) << "roughness " << roughness;
  }
}

// Check direct light against Monte Carlo's leaves: the same formulas, of half-way vectors that were rounded in other
// axes, which a lobe of roughness 0.1 magnifies a hundredfold.
TEST(R20_FragmentShading, SendsDirectLightAsTracedLeavesDo) {
  const LeafOptics leaf{.reflectance = 0.3f, .transmittance = 0.2f, .gloss = 0.8f, .gloss_roughness = 0.1f};
  const TracedLeaf traced(leaf);
  const glm::vec3 travel = sunlight(0.7f, 1.f);
  const FragmentShading shading = leafShading(leaf, travel, 0.f, 0.f);
  Random random(4, 0);
  for (int i = 0; i < 1000; ++i) {
    auto [normal, to_eye] = drawnView(random);
    if (i % 4 == 0)
      to_eye = glm::normalize(2.f * dot(normal, -travel) * normal + travel + 0.1f * drawnDirection(random));
    if (dot(normal, to_eye) < 0.f) normal = -normal;
    const Shaded shaded = shading.shadeByLight(shading.leafSurface(0, {}, 0, 0, normal, to_eye), kFullLight, 0);
    const double expected = traced.sent(normal, to_eye, -travel);
    EXPECT_NEAR(shaded.direct[0], expected, 1e-4 * (1. + expected)) << i;
    EXPECT_EQ(shaded.scattered[0], 0.f);
  }
}

// Check that both halves together send what an even sky sends, whose closed form no table has part in, and that a leaf
// that absorbs nothing sends on all of it. To rounding.
TEST(R26_GlossTables, CountAllLightOnce) {
  for (const float roughness : {0.05f, 0.4f}) {
    const LeafOptics leaf{.reflectance = 0.7f, .transmittance = 0.3f, .gloss = 0.9f, .gloss_roughness = roughness};
    const FragmentShading shading = leafShading(leaf, sunlight(0.7f, 1.f), kTurn, kTurn);
    Random random(5, 0);
    for (int i = 0; i < 1000; ++i) {
      const auto [normal, to_eye] = drawnView(random);
      const Surface surface = shading.leafSurface(0, {}, 0, 0, normal, to_eye);
      EXPECT_NEAR(shading.shadeByLight(surface, kFullLight, 0).scattered[0], 1.f, 1e-5f);
      EXPECT_NEAR(shading.shadeBySky(surface, glm::vec3(1.f)).scattered[0], 1.f, 1e-5f);
    }
  }
}

TEST(R27_FragmentShading, ByStreamsIsThatOfTheSlab) {
  const LeafOptics leaf{.reflectance = 0.6f, .transmittance = 0.3f};
  TreeKind kind;
  kind.leaf.fill(leaf);
  ShadingData data;
  update(data, Model::nstreamg, std::array{kind}, std::array{sunAlong(kDown)});
  const FragmentShading shading(Model::nstreamg, data);
  const spp::StreamConstants constants = spp::nStreamConstants(spp::sphericalLeaves(leaf), 2, 1);
  for (const float thickness : {0.5f, 4.f, 30.f})
    for (const float part : {0.f, 0.3f, 1.f}) {
      const float depth = part * thickness, g = 0.7f;
      const auto light = spp::StreamSlab<double>(constants, 2. * double{thickness}).light(2. * double{depth});
      const double down = double{g} * (light.power_down - light.direct), up = double{g} * light.power_up;
      const FragmentLight at{.foliage = {depth, thickness - depth, 0.f}, .thickness = thickness, .compensation = g};
      const auto sent = [&](const glm::vec3& normal) {
        return double{shading.shadeByLight(shading.leafSurface(0, {}, 0, 0, normal, normal), at, 0).scattered[0]};
      };
      constexpr double kPi = std::numbers::pi;
      EXPECT_NEAR(sent({0.f, 0.f, 1.f}), (0.6 * down + 0.3 * up) / (2. * kPi), 3e-4);
      EXPECT_NEAR(sent({0.f, 0.f, -1.f}), (0.6 * up + 0.3 * down) / (2. * kPi), 3e-4);
      EXPECT_NEAR(sent({1.f, 0.f, 0.f}), 0.9 * (down + up) / (4. * kPi), 3e-4);
    }
}

// (R35) Check light that was scattered once before against the slab of leaves that scatter next to nothing, of whose
// light hardly any is scattered more often: their powers by their albedo differ from the limit by one scattering more,
// which at most z + 1 times 1e-7 of it are, and by a double's roundings over the albedo, 1e-9. That model's radiances
// are floats.
TEST(R35_FragmentShading, TellsLightScatteredOnceBefore) {
  const LeafOptics leaf{.reflectance = 0.55f, .transmittance = 0.35f};
  TreeKind kind;
  kind.leaf.fill(leaf);
  ShadingData data;
  update(data, Model::sppg, std::array{kind}, std::array{sunAlong(kDown)});
  const FragmentShading shading(Model::sppg, data);
  constexpr double kFaint = 1e-7;
  const double forward = double{spp::sphericalLeafForwardShare(leaf.reflectance, leaf.transmittance)};
  for (const float thickness : {0.5f, 4.f, 30.f})
    for (const float part : {0.f, 0.3f, 1.f}) {
      const float depth = part * thickness, g = 0.7f;
      const auto faint = spp::precise::sppPowers(double{depth}, double{thickness}, 1., kFaint, forward);
      const double scale = double{g} * double{leaf.albedo()} / kFaint;
      const double down = scale * (faint.down - std::exp(-double{depth})), up = scale * faint.up;
      const FragmentLight at{.foliage = {depth, thickness - depth, 0.f}, .thickness = thickness, .compensation = g};
      for (const glm::vec3 normal : {glm::vec3(0.f, 0.f, 1.f), glm::vec3(0.f, 0.f, -1.f), glm::vec3(0.6f, 0.f, 0.8f)}) {
        const Shaded shaded = shading.shadeByLight(shading.leafSurface(0, {}, 0, 0, normal, normal), at, 0);
        const double expected = spp::precise::lambertRadiance(spp::precise::halvesOnSides(double{normal.z}, {down, up}),
                                                              double{leaf.reflectance}, double{leaf.transmittance});
        EXPECT_NEAR(double{shaded.single[1]}, expected, 1e-6) << thickness << " " << part;
        EXPECT_LE(shaded.single[1], shaded.scattered[1] + 1e-6f);
      }
    }
}

// Check that what does not depend on lights is kept while leaves and model stay, and made anew when they change.
TEST(R27_FragmentShading, KeepsTablesWhileLeavesStay) {
  int made = 0;
  const spp::PowerTableOf counting = [&](const LeafOptics& leaf) {
    ++made;
    return uniformPowers(leaf.reflectance, 0.f)(leaf);
  };
  TreeKind kind;
  ShadingData data;
  update(data, Model::pp, std::array{kind}, std::array{sunAlong(kDown)}, counting);
  EXPECT_EQ(made, 1);  // bands that are alike share it
  update(data, Model::pp, std::array{kind}, std::array{sunAlong({1.f, 0.f, 0.f})}, counting);
  EXPECT_EQ(made, 1);
  EXPECT_EQ(data.lights[0].travel.x, 1.f);
  kind.leaf[2].reflectance = 0.1f;
  update(data, Model::pp, std::array{kind}, std::array{sunAlong(kDown)}, counting);
  EXPECT_EQ(made, 3);
  EXPECT_EQ(data.constants[0][2], 0.1f);
  EXPECT_THROW(update(data, Model::pp, std::array{kind, kind}, std::array{sunAlong(kDown)}), std::invalid_argument);
}
