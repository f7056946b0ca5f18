// Check that rays pass media as far as the density along them says, and that the leaves they meet are turned as leaves
// that they see.
#include "render/reference/detail/medium_field.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

#include "core/require.hpp"
#include "render/reference/ray_scene.hpp"
#include "scattering/leaf_scattering.hpp"
#include "tests/leaf_shapes.hpp"
#include "tests/medium_shapes.hpp"

using namespace sunfleck;
using namespace sunfleck::detail;
using namespace sunfleck::shapes;

namespace {

constexpr double kPi = std::numbers::pi;

glm::vec3 pointIn(Random& random, const glm::vec3& low, const glm::vec3& high) {
  const float u = random.uniform(), v = random.uniform(), w = random.uniform();
  return low + glm::vec3(u, v, w) * (high - low);
}

// The integral of what `density` tells at points of a ray, by the middles of many short steps.
double marched(const std::function<double(const glm::dvec3&)>& density, const glm::vec3& from, const glm::vec3& along,
               double length, int steps) {
  double sum = 0.;
  for (int i = 0; i < steps; ++i)
    sum += density(glm::dvec3(from) + (i + 0.5) * length / steps * glm::dvec3(along)) * length / steps;
  return sum;
}

}  // namespace

// Check the depth of voxels against a sum in small steps, with and without a period that is no whole number of cells,
// for rays from inside and outside; and that flights end where just that depth is passed. A step of 1 mm across a wall
// between cells errs by half of it times the step of the density: with some 60 walls, 0.1 as the rms step of density
// and signs at random, by 1e-3 at most.
TEST(R14_MediumField, DepthIsTheIntegralOfTheDensity) {
  const glm::vec3 corner(-0.3f, 0.2f, 1.f);
  const glm::ivec3 size(13, 9, 11);
  const float side = 0.1f;
  Random filling(5, 0);
  std::vector<float> values;
  for (int i = 0; i < size.x * size.y * size.z; ++i)
    values.push_back(filling.uniform() < 0.6f ? 0.f : 0.5f * filling.uniform());
  const auto at = [&](const glm::ivec3& cell) {
    return values[static_cast<std::size_t>((cell.x * size.y + cell.y) * size.z + cell.z)];
  };
  TraceMedium medium{.scatterer = TraceMedium::Scatterer::particles, .voxels = voxels(corner, side, size, at)};
  const glm::vec3 origin(0.5f, -3.f, 2.f);
  for (const bool periodic : {false, true}) {
    // The last cells along x reach beyond the period, by a quarter: they are that much denser and narrower.
    const glm::dvec2 period(1.275, 1.2);
    const std::optional<glm::vec2> of_stand = periodic ? std::optional(glm::vec2(period)) : std::nullopt;
    const MediumField field(medium, origin, of_stand);
    const auto density = [&](glm::dvec3 p) {
      p += glm::dvec3(origin) - glm::dvec3(corner);
      if (periodic)
        for (int axis = 0; axis < 2; ++axis) p[axis] -= period[axis] * std::floor(p[axis] / period[axis]);
      const glm::ivec3 cell(glm::floor(p / 0.1));
      for (int axis = 0; axis < 3; ++axis)
        if (p[axis] < 0. || cell[axis] >= size[axis]) return 0.;
      return double{at(cell)} * (periodic && cell.x == size.x - 1 ? 1. / 0.75 : 1.);
    };
    Random random(9, 0);
    for (int i = 0; i < 60; ++i) {
      const glm::vec3 from = pointIn(random, corner - origin - 0.7f, corner - origin + 2.f);
      glm::vec3 along = onSphere(random);
      if (periodic && std::abs(along.z) < 0.3f) along = glm::normalize(along + glm::vec3(0.f, 0.f, 1.f));
      if (i % 10 == 0) along = i % 20 ? glm::vec3(0.f, 0.f, -1.f) : glm::vec3(0.f, 0.f, 1.f);
      const double depth = marched(density, from, along, 12., 12'000);
      EXPECT_NEAR(field.depth(from, along), depth, 1e-3) << i;
      for (const float share : {0.1f, 0.6f}) {
        const float part = share * field.depth(from, along);
        if (part < 0.01f) continue;
        const Collision collision = field.fly(from, along, part);
        ASSERT_LT(collision.distance, 12.f);
        EXPECT_NEAR(marched(density, from, along, double{collision.distance}, 12'000), double{part}, 1e-3) << i;
      }
      EXPECT_EQ(field.fly(from, along, 1.01f * field.depth(from, along) + 1e-4f).distance, kEndless);
    }
  }
}

// Check boxes and layers of one density against the lengths of the ways through them, to some roundings.
TEST(R14_MediumField, HomogeneousDepthIsTheLengthInside) {
  const float rounding = 5e-6f;
  const TraceMedium box{.scatterer = TraceMedium::Scatterer::particles,
                        .box = {.low = {0.f, 0.f, 0.f}, .high = {1.f, 2.f, 3.f}},
                        .density = 0.5f};
  const MediumField alone(box, glm::vec3(0.f), {});
  EXPECT_NEAR(alone.depth({0.5f, 0.5f, 5.f}, {0.f, 0.f, -1.f}), 1.5f, rounding);
  EXPECT_NEAR(alone.depth({0.5f, 0.5f, 1.f}, {0.f, 1.f, 0.f}), 0.75f, rounding);
  EXPECT_EQ(alone.depth({2.5f, 0.5f, 1.f}, {0.f, 1.f, 0.f}), 0.f);
  const float half = std::sqrt(0.5f);
  EXPECT_NEAR(alone.depth({-1.f, 0.5f, -1.f}, {half, 0.f, half}), 0.5f * std::sqrt(2.f), rounding);
  EXPECT_NEAR(alone.fly({-1.f, 0.5f, -1.f}, {half, 0.f, half}, 0.25f).distance, std::sqrt(2.f) + 0.5f, rounding);

  // Repeated: the way of 3 m along x passes a box of 1 m in each period of 2 m, half of the way is inside.
  const MediumField repeated(box, glm::vec3(0.f), glm::vec2(2.f));
  const glm::vec3 flat = glm::normalize(glm::vec3(4.f, 0.f, -3.f));
  EXPECT_NEAR(repeated.depth({-0.3f, 7.5f, 5.f}, flat), 0.5f * 5.f * 0.5f, 2.f * rounding);

  const MediumField endless(layer(TraceMedium::Scatterer::leaves, 2.f), glm::vec3(0.f), glm::vec2(0.1f));
  EXPECT_NEAR(endless.depth({0.f, 0.f, 1.f}, glm::normalize(glm::vec3(100.f, 3.f, -1.f))), std::sqrt(10010.f),
              1e-5f * 100.f);
  EXPECT_EQ(endless.fly({0.f, 0.f, 2.f}, {0.f, 0.f, 1.f}, 0.1f).distance, kEndless);
  EXPECT_NEAR(endless.fly({0.f, 0.f, 0.5f}, {1.f, 0.f, 0.f}, 3.f).distance, 3.f, rounding);
}

// Check the leaves of an ellipsoid: light along s meets G(s) u of leaves; of those leaves the mean of |n . s'|, times
// G(s), does not depend on which of s and s' is which, as both stand for the mean of |n . s| |n . s'| over all leaves.
// Leaves that are parallel are met with their normal, whatever rounding has done to S. Within five standard errors.
TEST(R15_LeafNormals, EllipsoidIsSeenAsItsProjections) {
  Random random(3, 0);
  PathRandom path(Stream::light, 1, 1);
  for (int i = 0; i < 5; ++i) {
    const ProjectedArea area = randomArea(random);
    const LeafEllipsoid leaves(area, 2.f);
    const glm::vec3 a = onSphere(random), b = onSphere(random);
    const auto projection = [&](const glm::vec3& s) {
      return std::sqrt(area.xx * s.x * s.x + area.yy * s.y * s.y + area.zz * s.z * s.z +
                       2.f * (area.xy * s.x * s.y + area.xz * s.x * s.z + area.yz * s.y * s.z));
    };
    EXPECT_NEAR(glm::length(leaves.seen(a)), 2.f * projection(a), 1e-5f);
    const auto mean = [&](const glm::vec3& light, const glm::vec3& other) {
      constexpr int count = 20'000;
      double sum = 0., squares = 0.;
      for (int k = 0; k < count; ++k) {
        const glm::vec3 n = leaves.normal(light, path);
        EXPECT_GE(glm::dot(n, light), -1e-6f);
        const double seen = std::abs(double{glm::dot(n, other)});
        sum += seen / count;
        squares += seen * seen / count;
      }
      const double scale = double{projection(light)};
      return std::pair{scale * sum, scale * std::sqrt((squares - sum * sum) / count)};
    };
    const auto [there, its_error] = mean(a, b);
    const auto [back, other_error] = mean(b, a);
    EXPECT_NEAR(there, back, 5. * std::hypot(its_error, other_error)) << i;
  }
  const glm::vec3 n = glm::normalize(glm::vec3(1.f, -2.f, 0.5f)), s = glm::normalize(glm::vec3(1.f, 0.3f, 0.2f));
  const LeafEllipsoid parallel({n.x * n.x, n.y * n.y, n.z * n.z, n.x * n.y, n.x * n.z, n.y * n.z}, 1.f);
  EXPECT_NEAR(glm::length(parallel.seen(s)), std::abs(glm::dot(n, s)), 1e-4f);
  for (int k = 0; k < 100; ++k) EXPECT_GT(std::abs(glm::dot(parallel.normal(s, path), n)), 0.999f);
  const LeafEllipsoid flat({0.f, 0.f, 1.f, 0.f, 0.f, 0.f}, 1.f);
  EXPECT_EQ(std::abs(flat.normal(s, path).z), 1.f);
}

// Check leaves of named inclinations: G against its integral (P20), which the 64 inclinations that stand for all hit to
// 1e-4, and the mean of |n . s'| of the leaves that light along s meets against (P21), within five standard errors.
TEST(R15_LeafNormals, RingsAreSeenAsTheirProjections) {
  PathRandom path(Stream::light, 2, 1);
  Random random(4, 0);
  for (const char* name : {"planophile", "erectophile", "plagiophile", "extremophile", "uniform"}) {
    const LeafAngles angles = LeafAngles::named(name);
    const LeafRings rings(ringsOf(angles));
    for (const double mu : {0., 0.01, 0.3, 0.7, 0.999, 1.}) {
      const auto sigma = static_cast<float>(std::sqrt(1. - mu * mu));
      EXPECT_NEAR(rings.projection({sigma, 0.f, -static_cast<float>(mu)}), leafProjection(angles, mu), 1e-4)
          << name << mu;
    }
    for (int i = 0; i < 3; ++i) {
      const glm::vec3 s = onSphere(random), other = onSphere(random);
      constexpr int count = 20'000;
      double sum = 0., squares = 0.;
      for (int k = 0; k < count; ++k) {
        const double seen = std::abs(double{glm::dot(rings.normal(s, path), other)});
        sum += seen / count;
        squares += seen * seen / count;
      }
      // Leaves that reflect as much as they pass send (1 / 2 pi) <|n . s| |n . s'|> anywhere.
      const double turn = std::atan2(double{other.y}, double{other.x}) - std::atan2(double{s.y}, double{s.x});
      const double both = 2. * kPi * leafScattering({.angles = angles}, double{other.z}, double{s.z}, turn);
      const double scale = double{rings.projection(s)};
      EXPECT_NEAR(scale * sum, both, 5. * scale * std::sqrt((squares - sum * sum) / count) + 1e-4) << name << i;
    }
  }
}

// Check that what no medium can be is refused, each with one line.
TEST(R14_MediumField, RefusesInvalidInput) {
  const TraceMedium good = layer(TraceMedium::Scatterer::leaves, 1.f);
  EXPECT_NO_THROW(validate(good, glm::vec2(1.f)));
  EXPECT_THROW(validate(good, {}), InvalidInput);  // without end, and the stand is not periodic
  const auto refused = [&](const std::function<void(TraceMedium&)>& change) {
    TraceMedium medium = good;
    change(medium);
    EXPECT_THROW(validate(medium, glm::vec2(1.f)), InvalidInput);
  };
  refused([](TraceMedium& m) { m.density = -1.f; });
  refused([](TraceMedium& m) { m.density = kEndless; });
  refused([](TraceMedium& m) { m.asymmetry = 1.f; });
  refused([](TraceMedium& m) { m.box.high.z = m.box.low.z; });
  refused([](TraceMedium& m) { m.box.high.z = std::nanf(""); });
  refused([](TraceMedium& m) { m.box.low.x = 0.f, m.box.high.x = 1.1f; });  // wider than the period
  refused([](TraceMedium& m) { m.rings = {{.cosine = 0.5f, .weight = 0.9f}}; });
  refused([](TraceMedium& m) { m.rings = {{.cosine = 1.5f}}; });
  refused([](TraceMedium& m) { m.voxels = MediumVoxels{}; });
  const auto cells = [](int size) {
    return voxels({0.f, 0.f, 0.f}, 0.1f, glm::ivec3(size), [](const glm::ivec3&) { return 1.f; });
  };
  EXPECT_NO_THROW(validate({.voxels = cells(10)}, glm::vec2(0.95f)));
  EXPECT_THROW(validate({.voxels = cells(10)}, glm::vec2(0.85f)), InvalidInput);
  TraceMedium twice{.voxels = cells(9)};
  twice.voxels->blocks[1] = twice.voxels->blocks[0];
  EXPECT_THROW(RayScene({twice}, {}), InvalidInput);
  TraceMedium far{.voxels = cells(9)};
  far.voxels->blocks[1] = glm::ivec3(100'000);
  EXPECT_THROW(RayScene({far}, {}), InvalidInput);
  TraceMedium wrong{.voxels = cells(1)};
  wrong.voxels->density[0] = std::nanf("");
  EXPECT_THROW(RayScene({wrong}, {}), InvalidInput);
  EXPECT_THROW(RayScene(std::vector<TraceMedium>{}, {}), InvalidInput);  // nothing at all
}
