// Check that a sweep's file becomes the combinations that it tells, in a stable order, and that a number stands where a
// list may.
#include "render/sweep_file.hpp"

#include <gtest/gtest.h>

#include "core/require.hpp"
#include "tests/temporary_folder.hpp"

using namespace sunfleck;

namespace {

SweepFile sweepOf(const std::string& text) {
  const TemporaryFolder folder;
  return readSweepFile(folder.write("sweep.toml", text));
}

}  // namespace

TEST(SweepFile, CombinesAllWithAll) {
  const SweepFile sweep = sweepOf(R"(
scenes = ["cherry", "trees/oak.toml"]
models = ["sppg", "mc"]
sun.zenith_deg = [10, 20]
sun.azimuth_deg = [0, 90, 180]
leaf.reflectance = [0.1, 0.4]
leaf.transmittance = [0.2, 0.5]
ground.albedo = [0.0, 0.3]
wood.reflectance = 0.25
wood.traced = false
effort = { paths = 1e5, target = 0.01, seed = 9 }
)");
  EXPECT_EQ(sweep.scenes, (std::vector<std::string>{"cherry", "trees/oak.toml"}));
  EXPECT_EQ(sweep.sceneFile(0), "cherry");
  EXPECT_EQ(sweep.sceneFile(1), (sweep.path.parent_path() / "trees/oak.toml").string());
  EXPECT_TRUE(sweep.monte_carlo);
  EXPECT_EQ(sweep.models, std::vector{Model::sppg});
  EXPECT_EQ(sweep.rowsEach(), 2u);
  EXPECT_FALSE(sweep.with_wood);
  EXPECT_EQ(sweep.paths, 1e5);
  EXPECT_EQ(sweep.target, 0.01);
  EXPECT_EQ(sweep.seed, 9u);
  ASSERT_EQ(sweep.suns.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(sweep.suns[i].zenith_deg, i < 3 ? 10. : 20.);
    EXPECT_EQ(sweep.suns[i].azimuth_deg, 90. * static_cast<double>(i % 3));
  }
  ASSERT_EQ(sweep.optics.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const LeafOptics leaf = i < 2 ? LeafOptics{.reflectance = 0.1f, .transmittance = 0.2f}
                                  : LeafOptics{.reflectance = 0.4f, .transmittance = 0.5f};
    EXPECT_EQ(sweep.optics[i].leaf, leaf);
    EXPECT_EQ(sweep.optics[i].ground_albedo, i % 2 == 0 ? 0.f : 0.3f);
    EXPECT_EQ(sweep.optics[i].wood_reflectance, 0.25f);
  }
}

// What is not told is the scene's own.
TEST(SweepFile, LeavesTheRestToTheScene) {
  const SweepFile sweep = sweepOf("scenes = \"slab\"\nleaf.band = [2, 0]\n");
  EXPECT_TRUE(sweep.monte_carlo && sweep.models.empty() && sweep.with_wood);
  EXPECT_FALSE(sweep.paths || sweep.target || sweep.seed);
  ASSERT_EQ(sweep.suns.size(), 1u);
  EXPECT_FALSE(sweep.suns[0].zenith_deg || sweep.suns[0].azimuth_deg);
  ASSERT_EQ(sweep.optics.size(), 2u);
  EXPECT_EQ(sweep.optics[0].band, 2);
  EXPECT_EQ(sweep.optics[1].band, 0);
  EXPECT_FALSE(sweep.optics[0].leaf || sweep.optics[0].wood_reflectance || sweep.optics[0].ground_albedo);
}

// A million rows are taken, and one more is refused before anything is made of them.
TEST(SweepFile, HasAtMostAMillionRows) {
  const auto listed = [](int count, double step) {
    std::string text = "[0";
    for (int i = 1; i < count; ++i) text.append(",").append(std::to_string(step * i));
    return text.append("]");
  };
  const std::string scenes = "scenes = [\"slab\"]\nsun.azimuth_deg = " + listed(1000, 0.1) + "\n";
  EXPECT_EQ(sweepOf(scenes + "sun.zenith_deg = " + listed(1000, 0.05)).suns.size(), 1'000'000u);
  EXPECT_THROW(sweepOf(scenes + "sun.zenith_deg = " + listed(1001, 0.05)), InvalidInput);
}
