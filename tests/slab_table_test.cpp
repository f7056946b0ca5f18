#include "pp_solver/slab_table.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <numbers>
#include <string>

#include "core/random.hpp"
#include "core/require.hpp"
#include "pp_solver/detail/slab_table_data.hpp"
#include "pp_solver/detail/table_axis.hpp"
#include "pp_solver/slab_table_file.hpp"
#include "pp_solver/solver.hpp"
#include "tests/temporary_folder.hpp"

// Tables of slabs against the solver that made them, and their files against damage.
namespace {

using namespace sunfleck;
using namespace sunfleck::pp;
namespace fs = std::filesystem;
constexpr double kPi = std::numbers::pi;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

Medium henyeyGreenstein(double albedo, double g) {
  return Particles{albedo, PhaseFunction::henyeyGreenstein(g)};
}

// Coarse, so that they are made soon: each is measured against its own bound.
const SlabTable& particleTable() {
  static const SlabTable table =
      *SlabTable::build(henyeyGreenstein(0.9, 0.3), {.max_thickness = 6., .max_error = 0.3, .streams = 16});
  return table;
}
const Medium& leaves() {
  static const Medium medium =
      LeafScattering{.angles = LeafAngles::planophile(), .reflectance = 0.4, .transmittance = 0.3};
  return medium;
}
const SlabTable& leafTable() {
  static const SlabTable table =
      *SlabTable::build(leaves(), {.max_thickness = 6., .max_error = 0.3, .streams = 16, .note = "planophile"});
  return table;
}

std::string bytesOf(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
void writeBytes(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}
std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const InvalidInput& e) {
    return e.what();
  }
  return "accepted";
}

// Check at fresh places that the errors of radiance and powers stay below the bound that the table states, against a
// solver of 64 streams, and that P+ + P- is what the solver's mean intensity says, which the table was not made from:
// 128 streams give that to 5e-4 near the faces, where ordinates cannot follow light that grazes them.
void boundHolds(const Medium& medium, const SlabTable& table) {
  Solver solver({.streams = 64, .azimuth_tolerance = 1e-9}), fine({.streams = 128});
  const double bound = table.errors().bound();
  EXPECT_GT(bound, 0.);
  EXPECT_LE(bound, 0.3);  // as asked for
  EXPECT_LE(table.errors().radiance_rms, table.errors().radiance_max);
  Random random(77, 0);
  double largest = 0., power_square = 0.;
  int powers_compared = 0;
  for (int i = 0; i < 60; ++i) {
    const bool thin = i % 2 == 0;  // as often thin as thick, and as often grazing as steep
    const auto w = static_cast<float>(6. * std::pow(random.uniformDouble(), thin ? 3. : 1.) + 1e-6);
    const auto mu0 = static_cast<float>(std::pow(random.uniformDouble(), thin ? 2. : 1.) + 1e-6);
    const float z = w * random.uniform();
    Problem problem;
    problem.layers.push_back({.thickness = static_cast<double>(w), .medium = medium});
    problem.beam = Beam{.mu0 = std::min(1., static_cast<double>(mu0))};
    solver.solve(problem);
    for (int k = 0; k < 6; ++k) {
      const float mu = std::max(1e-6f, random.uniform()) * (k % 2 ? 1.f : -1.f), azimuth = 3.14159f * random.uniform();
      const double exact =
          solver.radiance(static_cast<double>(z), static_cast<double>(mu), static_cast<double>(azimuth));
      const auto found = static_cast<double>(table.radiance(w, z, mu0, mu, azimuth));
      EXPECT_LE(4. * kPi * std::abs(found - exact), bound)
          << w << " " << z << " " << mu0 << " " << mu << " " << azimuth;
      largest = std::max(largest, 4. * kPi * std::abs(found - exact));
    }
    if (i % 3) continue;
    const SlabTablePowers powers = table.powers(w, z, mu0);
    fine.solve(problem);
    const Fluxes fluxes = fine.fluxes(static_cast<double>(z));
    const double direct = fluxes.direct / problem.beam->mu0;
    EXPECT_NEAR(static_cast<double>(powers.direct), direct, 2e-6);  // G by a spline
    const double sum = static_cast<double>(powers.down + powers.up), exact = 4. * kPi * fluxes.mean_intensity - direct;
    EXPECT_NEAR(sum, exact, 2. * SlabTableErrors::kSafety * table.errors().power_max + 5e-4)
        << w << " " << z << " " << mu0;
    power_square += (sum - exact) * (sum - exact);
    ++powers_compared;
    EXPECT_NEAR(static_cast<double>(table.powers(w, 0.f, mu0).down), 0., bound);
    EXPECT_NEAR(static_cast<double>(table.powers(w, w, mu0).up), 0., bound);
  }
  EXPECT_GT(largest, 0.01 * bound);  // the bound is not idle
  // No error of the powers' formula hides below the bound, which the worst corner makes: the sum of both is as far off
  // as the table says, places chosen here lying more often in corners than those of its own.
  EXPECT_LE(std::sqrt(power_square / powers_compared), 4. * table.errors().power_rms + 5e-4);
}

TEST(P12_SlabTable, KeepsItsBoundForParticles) {
  boundHolds(henyeyGreenstein(0.9, 0.3), particleTable());
}
TEST(P12_SlabTable, KeepsItsBoundForLeaves) {
  boundHolds(leaves(), leafTable());
}

// Check that the error asked for is reached, and that one which the size does not allow is refused.
TEST(P12_SlabTable, ReachesTheErrorAskedFor) {
  const auto made =
      SlabTable::build(henyeyGreenstein(0.5, 0.), {.max_thickness = 1., .max_error = 0.02, .streams = 16});
  ASSERT_TRUE(made);
  EXPECT_LE(made->errors().bound(), 0.02);
  EXPECT_EQ(made->azimuthModes(), 1);  // isotropic
  const std::string why = refusal([] {
    (void)SlabTable::build(henyeyGreenstein(0.9, 0.3),
                           {.max_error = 1e-6, .max_bytes = std::size_t{1} << 20, .streams = 16});
  });
  EXPECT_NE(why.find("max_error = 1e-06: must be at least"), std::string::npos) << why;
}

// Check that light scattered once, in single precision, is what the phase function gives, at narrow peaks forward and
// backward too: 1e-4 of the value, where |s - s0|^2, of rounding 1e-7, is compared with (1 - g)^2 = 2.5e-3; splines of
// other functions to 1e-5.
TEST(P12_FirstScattering, IsThePhaseFunction) {
  using detail::FirstScattering;
  Random random(5, 0);
  const std::vector<double> moments{1., 0.4, 0.3, 0.1};
  const auto compare = [&](const Medium& medium, double tolerance) {
    const FirstScattering first = FirstScattering::of(medium);
    for (int i = 0; i < 300; ++i) {
      const float mu0 = std::max(1e-4f, random.uniform());
      const float mu = i % 3 == 0 ? mu0 : i % 3 == 1 ? -mu0 : 2.f * random.uniform() - 1.f;
      const float azimuth = (i % 2 ? 3.14159f : 0.02f) * random.uniform();
      const double exact =
          scatteredInto(medium, static_cast<double>(mu), static_cast<double>(mu0), static_cast<double>(azimuth));
      EXPECT_NEAR(static_cast<double>(first.into(mu, mu0, std::cos(azimuth))), exact, tolerance * (exact + 0.1));
    }
    return first.kind;
  };
  for (double g : {-0.95, -0.3, 0., 0.5, 0.95})
    EXPECT_EQ(compare(henyeyGreenstein(0.8, g), 1e-4), FirstScattering::Kind::henyeyGreenstein);
  EXPECT_EQ(compare(Particles{0.8, PhaseFunction::fromMoments(moments)}, 1e-5), FirstScattering::Kind::angle);
  // Gamma's azimuth series is cut at 16 modes.
  EXPECT_EQ(compare(LeafScattering{}, 1e-3), FirstScattering::Kind::leaves);
}

// Check that a spline gives back a cubic polynomial, ends included, to single precision.
TEST(P12_Spline, GivesBackCubics) {
  const auto cubic = [](double t) { return 1. + t * (2. - t * (3. - 4. * t)); };
  constexpr int nodes = 7;
  std::vector<double> values;
  for (int i = 0; i < nodes; ++i) values.push_back(cubic(i / (nodes - 1.)));
  const std::vector<double> coefficients = detail::splineCoefficients(values, 1, nodes, 1);
  for (double t = 0.; t <= 1.; t += 1. / 64.) {
    const detail::SplineWeights at(static_cast<float>(t), nodes);
    double found = 0.;
    for (int i = 0; i < 4; ++i) found += static_cast<double>(at.weight[i]) * coefficients[at.first + i];
    EXPECT_NEAR(found, cubic(t), 3e-6) << t;  // weights of rounding 6e-8 times coefficients up to 10
  }
}

// Check that each axis leads back to where it came from: a few roundings of single precision.
TEST(P12_Axes, AreInverted) {
  for (double most : {0.01, 1., 16., 1000.})
    for (double t : {0., 0.01, 0.3, 0.77, 1.}) {
      const detail::ThicknessAxis axis(most);
      EXPECT_NEAR(axis.coordinate(static_cast<float>(axis.thickness(t))), t, 1e-6);
      const double z = detail::DepthAxis::depth(most, t);
      // near the lower face the digits of w - z are those of w
      EXPECT_NEAR(detail::DepthAxis::coordinate(static_cast<float>(most), static_cast<float>(z)), t, 1e-3);
      EXPECT_NEAR(detail::cosineCoordinate(static_cast<float>(detail::cosineFrom(t))), t, 1e-3);
    }
}

// Check that any input gives finite light that is not negative, and that what is out of range is taken as the nearest
// within.
TEST(P12_SlabTable, IsSafeForAnyInput) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const float odd[] = {nan, inf, -inf, -1.f, -0.f, 0.f, 1e-45f, 1e-20f, 1e-6f, 0.5f, 1.f, 1.0001f, 6.f, 1e30f};
  for (const SlabTable* table : {&particleTable(), &leafTable()}) {
    for (float w : odd)
      for (float z : odd)
        for (float mu0 : odd) {
          const SlabTablePowers p = table->powers(w, z, mu0);
          EXPECT_TRUE(p.down >= 0.f && p.up >= 0.f && p.direct >= 0.f && p.down + p.up + p.direct < 100.f);
          for (float mu : odd)
            for (float azimuth : {nan, inf, -3.f, 1e30f}) {
              const float radiance = table->radiance(w, z, mu0, mu, azimuth);
              EXPECT_TRUE(radiance >= 0.f && radiance < 100.f) << w << " " << z << " " << mu0 << " " << mu;
            }
        }
    EXPECT_EQ(table->radiance(60.f, 2.f, 0.5f, -0.3f, 1.f), table->radiance(6.f, 2.f, 0.5f, -0.3f, 1.f));
    EXPECT_EQ(table->radiance(3.f, 9.f, 0.5f, 0.3f, 1.f), table->radiance(3.f, 3.f, 0.5f, 0.3f, 1.f));
    EXPECT_EQ(table->powers(60.f, 50.f, 0.5f).down, table->powers(6.f, 6.f, 0.5f).down);
  }
}

// Check that a file gives back the same bits, that threads do not change them, and what it tells of itself.
TEST(P12_SlabTableFile, GivesBackTheSameBits) {
  const TemporaryFolder folder;
  for (const SlabTable* table : {&particleTable(), &leafTable()}) {
    writeSlabTable(folder / "a.sft", *table);
    const SlabTable back = readSlabTable(folder / "a.sft");
    writeSlabTable(folder / "b.sft", back);
    EXPECT_EQ(bytesOf(folder / "a.sft"), bytesOf(folder / "b.sft"));
    EXPECT_EQ(back.about(), table->about());
    EXPECT_EQ(back.errors().bound(), table->errors().bound());
    EXPECT_EQ(back.bytes(), table->bytes());
    EXPECT_EQ(back.radiance(2.f, 1.f, 0.7f, -0.2f, 0.5f), table->radiance(2.f, 1.f, 0.7f, -0.2f, 0.5f));
  }
  EXPECT_NE(leafTable().about().find("planophile"), std::string::npos);
  EXPECT_NE(particleTable().about().find("omega 0.9, g 0.3"), std::string::npos) << particleTable().about();

  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const auto alone =
      SlabTable::build(henyeyGreenstein(0.9, 0.3), {.max_thickness = 6., .max_error = 0.3, .streams = 16});
  writeSlabTable(folder / "a.sft", particleTable());
  writeSlabTable(folder / "b.sft", *alone);
  EXPECT_EQ(bytesOf(folder / "a.sft"), bytesOf(folder / "b.sft"));
}

// Check that no damaged file is read: bytes changed, cut off, added, each in one line with the file's name.
TEST(P12_SlabTableFile, RefusesDamage) {
  const TemporaryFolder folder;
  const fs::path path = folder / "table.sft";
  writeSlabTable(path, particleTable());
  const std::string whole = bytesOf(path);
  const auto refused = [&](const std::string& bytes) {
    writeBytes(path, bytes);
    const std::string why = refusal([&] { (void)readSlabTable(path); });
    EXPECT_TRUE(why.starts_with(path.string() + ": ")) << why;
    EXPECT_EQ(why.find('\n'), std::string::npos) << why;
    return why;
  };
  Random random(9, 0);
  const auto place = [&](std::size_t size) { return static_cast<std::size_t>(random.bits() % size); };
  for (int i = 0; i < 200; ++i) {
    std::string bytes = whole;
    // Half of them where the file says what it is.
    bytes[place(i % 2 ? bytes.size() : 120)] ^= static_cast<char>(1 + random.bits() % 255);
    refused(bytes);
  }
  for (int i = 0; i < 100; ++i) refused(whole.substr(0, place(i % 2 ? whole.size() : 140)));
  for (int i = 0; i < 20; ++i) refused(whole + std::string(1 + place(5000), static_cast<char>(random.bits())));

  EXPECT_NE(refused("").find("is no table of slabs"), std::string::npos);
  EXPECT_NE(refused("v 0 0 1\nv 1 0 1\n").find("is no table of slabs"), std::string::npos);
  EXPECT_NE(refused(whole.substr(0, 15)).find("within its header"), std::string::npos);
  EXPECT_NE(refused(whole.substr(0, 1000)).find("cut short"), std::string::npos);
  EXPECT_NE(refused(whole + "x").find("bytes, and says that it has"), std::string::npos);
  std::string flipped = whole;
  flipped[whole.size() / 2] ^= 1;
  EXPECT_NE(refused(flipped).find("checksum"), std::string::npos);
  EXPECT_NE(refusal([&] { (void)readSlabTable(folder / "none.sft"); }).find("none.sft"), std::string::npos);
  EXPECT_NE(refusal([&] { (void)readSlabTable(folder.path()); }).find("no regular file"), std::string::npos);
}

// Check that a file whose checksum is right but whose contents are not is refused too, naming what is wrong.
TEST(P12_SlabTableFile, RefusesWrongContents) {
  const TemporaryFolder folder;
  const fs::path path = folder / "table.sft";
  writeSlabTable(path, particleTable());
  const std::string whole = bytesOf(path);
  const auto with = [&](std::size_t at, const auto& value) {
    std::string bytes = whole;
    std::memcpy(bytes.data() + at, &value, sizeof value);
    const auto seal =
        static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size() - 4));
    std::memcpy(bytes.data() + bytes.size() - 4, &seal, 4);
    writeBytes(path, bytes);
    return refusal([&] { (void)readSlabTable(path); });
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  // Offsets are those of the file's layout: 24 bytes of header, then the fields in their order.
  const std::pair<std::string, std::string> cases[] = {
      {with(8, 2), "version = 2: must be 1"},
      {with(12, 5), "byte order = 5"},
      {with(24, 7), "kind of medium = 7"},
      {with(24, 1), "sizes ask for"},
      {with(28, 1.5f), "albedo = 1.5"},
      {with(28, nan), "albedo = nan"},
      {with(32, 1.f), "g = 1"},
      {with(36, -4), "streams = -4"},
      {with(40, std::numeric_limits<int>::max()), "nodes of an axis = 2147483647"},
      {with(44, 500), "sizes ask for"},
      {with(56, 0), "azimuth modes = 0"},
      {with(60, -1), "places = -1"},
      {with(64, kInfinite), "max_thickness = inf"},
      {with(72, -1.), "error = -1"},
      {with(104, 0xFFFFFFFFu), "length of the description"},
      {with(108, '\n'), "description is not printable"},
      {with(whole.size() - 8, nan), "value of the radiance = nan"},
      {with(whole.size() - 8, std::numeric_limits<float>::infinity()), "value of the radiance = inf"}};
  for (const auto& [found, expected] : cases) EXPECT_NE(found.find(expected), std::string::npos) << found;
}

// Check that a build that is told to stop does, wherever it is, and that progress only rises.
TEST(P12_SlabTable, IsInterrupted) {
  double before = 0.;
  int calls = 0;
  const SlabTableSettings settings{.max_thickness = 2., .max_error = 0.5, .streams = 8};
  const auto whole = SlabTable::build(henyeyGreenstein(0.5, 0.), settings, [&](double done) {
    EXPECT_GE(done, before);
    EXPECT_LE(done, 1.);
    before = done;
    ++calls;
    return true;
  });
  EXPECT_TRUE(whole);
  EXPECT_EQ(before, 1.);
  for (int stop : {1, 2, calls / 3, calls / 2, calls}) {
    int count = 0;
    EXPECT_FALSE(SlabTable::build(henyeyGreenstein(0.5, 0.), settings, [&](double) { return ++count < stop; }));
    EXPECT_EQ(count, stop);  // and it is not asked again
  }
}

// Check that media and settings that are none are refused by name.
TEST(P12_SlabTable, RefusesWrongSettings) {
  const Medium good = henyeyGreenstein(0.5, 0.);
  const auto why = [](const Medium& medium, const SlabTableSettings& settings) {
    return refusal([&] { (void)SlabTable::build(medium, settings); });
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(why(henyeyGreenstein(1.5, 0.), {}).find("albedo = 1.5"), std::string::npos);
  EXPECT_NE(why(LeafScattering{.reflectance = 0.9, .transmittance = 0.9}, {}).find("reflectance"), std::string::npos);
  EXPECT_NE(why(LeafScattering{.hot_spot = 0.1}, {}).find("hot_spot = 0.1"), std::string::npos);
  EXPECT_NE(why(good, {.max_thickness = kInfinite}).find("max_thickness = inf"), std::string::npos);
  EXPECT_NE(why(good, {.max_thickness = nan}).find("max_thickness = nan"), std::string::npos);
  EXPECT_NE(why(good, {.max_error = -1.}).find("max_error = -1"), std::string::npos);
  EXPECT_NE(why(good, {.max_bytes = 5}).find("max_bytes = 5"), std::string::npos);
  EXPECT_NE(why(good, {.streams = 9}).find("streams = 9"), std::string::npos);
  EXPECT_NE(why(good, {.note = "two\nlines"}).find("note"), std::string::npos);
}

}  // namespace
