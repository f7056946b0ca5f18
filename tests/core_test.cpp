#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <mutex>
#include <numbers>
#include <thread>

#include "core/directions.hpp"
#include "core/leaf_optics.hpp"
#include "core/random.hpp"
#include "core/require.hpp"
#include "core/shared_progress.hpp"
#include "core/tree_mesh.hpp"
#include "core/whole_file.hpp"
#include "tests/temporary_folder.hpp"

using namespace sunfleck;
namespace fs = std::filesystem;

// Check that sunlight travels down from overhead, and away from the side where the sun stands.
TEST(Directions, SunlightTravelsAwayFromTheSun) {
  EXPECT_NEAR(sunlight(0.f, 0.f).z, -1.f, 1e-7f);
  const Direction low = sunlight(0.5f * std::numbers::pi_v<float>, 0.f);  // sun on the horizon in +x
  EXPECT_NEAR(low.x, -1.f, 1e-6f);
  EXPECT_NEAR(low.z, 0.f, 1e-6f);
}

// Check that axes are orthonormal and right-handed along any direction, the poles included. Error: a few ulp.
TEST(Directions, AxesAreOrthonormal) {
  std::vector<Direction> directions = spreadAxes(50);
  directions.push_back({0.f, 0.f, 1.f});
  directions.push_back({0.f, 0.f, -1.f});
  for (const Direction& along : directions) {
    const Axes axes = axesAlong(along);
    EXPECT_NEAR(glm::dot(axes.right, axes.up), 0.f, 4e-7f);
    EXPECT_NEAR(glm::length(axes.right), 1.f, 4e-7f);
    EXPECT_NEAR(glm::length(glm::cross(axes.right, axes.up) - along), 0.f, 8e-7f);
  }
}

// Check that spread axes integrate the second moments of the sphere: mean x_i x_j = delta_ij / 3. Axes of least energy
// are isotropic but for few of them: 8 are 9e-3 off when they have come to rest (axes at random are 0.1 off). Larger
// sets are Fibonacci points, whose error for such smooth functions falls faster than 1 / count.
TEST(Directions, SpreadAxesHaveIsotropicMoments) {
  for (int count : {6, 8, 11, 24, 100, 200}) {
    glm::dmat3 moments(0.);
    for (const glm::dvec3 s : spreadAxes(count)) moments += glm::outerProduct(s, s) / double(count);
    const double error = count <= kMostRelaxedAxes ? 1e-2 : 1. / count;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) EXPECT_NEAR(moments[i][j], i == j ? 1. / 3. : 0., error) << count;
  }
}

// Check that no axis of the usual sets is nearly level: a ten degrees' rise keeps the way through a level layer
// below 5.7 times its height. Unturned, 24 axes have one that rises 0.4 degrees.
TEST(Directions, SpreadAxesRise) {
  for (int count : {6, 8, 11, 16, 24})
    for (const Direction& axis : spreadAxes(count)) EXPECT_GT(std::abs(axis.z), std::sin(0.1745f)) << count;
}

// Check that six axes are those of an icosahedron, whose neighbours stand acos(1 / sqrt 5) apart: the least energy
// known. The descent comes within 1e-3 of it.
TEST(Directions, SixSpreadAxesAreAnIcosahedrons) {
  const std::vector<Direction> axes = spreadAxes(6);
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_NEAR(std::abs(glm::dot(axes[i], axes[j])), std::sqrt(0.2f), 1e-3f);
}

TEST(LeafOptics, RefusesSharesThatMakeLight) {
  EXPECT_NO_THROW(validate(LeafOptics{.reflectance = 0.6f, .transmittance = 0.4f}));
  for (const LeafOptics bad :
       {LeafOptics{-0.1f, 0.f}, LeafOptics{0.7f, 0.7f}, LeafOptics{std::nanf(""), 0.f}, LeafOptics{0.6f, 0.4000001f}})
    EXPECT_THROW(validate(bad), InvalidInput);
}

// Check that streams differ, repeat, and are uniform: mean of n uniform numbers is 1/2 with standard error
// 1 / sqrt(12 n); 5 of them is a false alarm of 6e-7.
TEST(Random, StreamsAreReproducibleAndUniform) {
  EXPECT_EQ(Random(1, 2).bits(), Random(1, 2).bits());
  EXPECT_NE(Random(1, 2).bits(), Random(1, 3).bits());
  EXPECT_NE(Random(1, 2).bits(), Random(2, 2).bits());
  Random random(7, 0);
  constexpr int n = 1'000'000;
  double sum = 0.;
  for (int i = 0; i < n; ++i) {
    const float x = random.uniform();
    ASSERT_GE(x, 0.f);
    ASSERT_LT(x, 1.f);
    sum += double{x};
  }
  EXPECT_NEAR(sum / n, 0.5, 5. / std::sqrt(12. * n));
}

namespace {

// Two squares that share no vertex, one triangle of no area, and a wood triangle.
TreeMesh twoLeaves() {
  TreeMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 2}, {2, 0, 2}, {2, 2, 2}, {0, 2, 2}};
  mesh.leaf_triangles = {{0, 1, 2}, {4, 5, 6}, {0, 0, 1}, {0, 2, 3}, {4, 6, 7}};
  mesh.wood_triangles = {{0, 1, 4}};
  return mesh;
}

// Check that a signal's handler can remove what is half written, and does no harm when nothing is.
TEST(WholeFile, IsRemovedUnfinished) {
  const TemporaryFolder folder;
  removeUnfinished();
  EXPECT_THROW(writeWhole(folder / "a.txt",
                          [&](const fs::path& temporary) {
                            std::ofstream(temporary) << "half";
                            EXPECT_EQ(folder.files(), 1);
                            removeUnfinished();
                            EXPECT_EQ(folder.files(), 0);
                            throw std::runtime_error("ended");
                          }),
               std::runtime_error);
  writeWhole(folder / "b.txt", "whole");
  removeUnfinished();
  EXPECT_EQ(folder.files(), 1);
  // A place that takes no file is known before the work.
  EXPECT_THROW(requireWritable("/proc/x.txt"), InvalidInput);
  EXPECT_THROW(requireWritable(folder / std::string(250, 'x')), InvalidInput);
}

}  // namespace

// Check that leaves are told apart by shared vertices, whatever the order of their triangles, and that areas are exact.
TEST(TreeMesh, FinishGroupsLeavesAndDropsFlatTriangles) {
  TreeMesh mesh = twoLeaves();
  const Dropped dropped = finish(mesh, "test");
  EXPECT_EQ(dropped.leaf_triangles, 1u);
  EXPECT_EQ(mesh.leaf_count, 2u);
  EXPECT_EQ(mesh.leaf_of_triangle, (std::vector<std::uint32_t>{0, 1, 0, 1}));
  EXPECT_DOUBLE_EQ(leafAreas(mesh)[0], 1.);
  EXPECT_DOUBLE_EQ(leafAreas(mesh)[1], 4.);
  EXPECT_DOUBLE_EQ(leafArea(mesh), 5.);
}

TEST(TreeMesh, FinishRefusesBrokenMeshes) {
  TreeMesh out_of_range = twoLeaves();
  out_of_range.leaf_triangles.push_back({0, 1, 99});
  EXPECT_THROW(finish(out_of_range, "test"), InvalidInput);

  TreeMesh not_finite = twoLeaves();
  not_finite.vertices[3].y = std::numeric_limits<float>::quiet_NaN();
  try {
    finish(not_finite, "tree.obj");
    FAIL() << "a NaN went through";
  } catch (const InvalidInput& e) {
    EXPECT_EQ(std::string(e.what()),
              "tree.obj: vertex 4 y = nan: must be a finite number of metres, at most 1e4 in size");
  }

  TreeMesh only_wood = twoLeaves();
  only_wood.leaf_triangles.clear();
  EXPECT_THROW(finish(only_wood, "test"), InvalidInput);
}

// Check that threads that share work tell of it one at a time, of no less than was told before and at last of all of
// it, and that all of them end once one was told to.
TEST(SharedProgress, IsToldByOneThreadAtATimeAndEndsAll) {
  constexpr int kThreads = 4, kParts = 1000;
  for (const int most_calls : {std::numeric_limits<int>::max(), 10}) {
    int calls = 0, inside = 0, ended = 0;  // guarded by what is tested; `ended` by its mutex
    double before = 0.;
    const Progress progress = [&](double done) {
      EXPECT_EQ(++inside, 1);
      EXPECT_GE(done, before);
      EXPECT_LE(done, 1.);
      before = done;
      --inside;
      return ++calls < most_calls;
    };
    SharedProgress shared(progress, kThreads * kParts + 1);
    std::mutex of_ended;
    const auto work = [&] {
      try {
        for (int i = 0; i < kParts; ++i) shared.add();
      } catch (const std::runtime_error& interrupted) {
        EXPECT_STREQ(interrupted.what(), "interrupted");
        const std::lock_guard lock(of_ended);
        ++ended;
      }
    };
    {
      std::vector<std::jthread> threads;
      for (int i = 0; i < kThreads; ++i) threads.emplace_back(work);
    }
    if (most_calls == 10) {
      // A thread may have been done before.
      EXPECT_EQ(calls, 10);
      EXPECT_GE(ended, 1);
      EXPECT_THROW(shared.add(), std::runtime_error);
      EXPECT_THROW(shared.ask(), std::runtime_error);
      EXPECT_EQ(calls, 10);
    } else {
      EXPECT_EQ(ended, 0);
      EXPECT_TRUE(shared.asking()(0.5));  // tells nothing of its own
      shared.add();
      EXPECT_EQ(before, 1.);
    }
  }
  const Progress none;
  SharedProgress silent(none, 1.);
  silent.add();
  silent.ask();
  EXPECT_FALSE(silent.asking());
}

// Check that no wrong value reads as a right one: the nearest above 1 of either precision is not told as 1.
TEST(Require, TellsAValueApartFromItsRule) {
  const auto told = [](auto value) {
    try {
      require(value <= 1, "omega", value, "in [0, 1]");
    } catch (const InvalidInput& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_EQ(told(1. + 0x1p-52), "omega = 1.0000000000000002: must be in [0, 1]");
  EXPECT_EQ(told(1.f + 0x1p-23f), "omega = 1.0000001: must be in [0, 1]");
  EXPECT_EQ(told(0.1f + 1.f), "omega = 1.1: must be in [0, 1]");
  EXPECT_EQ(told(2), "omega = 2: must be in [0, 1]");
  EXPECT_EQ(told(1.), "");
}

// Check that a file appears whole, and that a writer that fails leaves neither a file nor its temporary.
TEST(WholeFile, IsWrittenWholeOrNotAtAll) {
  const TemporaryFolder folder;
  writeWhole(folder / "a.txt", "content");
  std::ifstream in(folder / "a.txt");
  std::string read;
  in >> read;
  EXPECT_EQ(read, "content");
  EXPECT_THROW(writeWhole(folder / "b.txt",
                          [](const fs::path& temporary) {
                            std::ofstream(temporary) << "half";
                            throw std::runtime_error("disk on fire");
                          }),
               std::runtime_error);
  EXPECT_THROW(writeWhole(folder / "none" / "c.txt", "x"), InvalidInput);
  EXPECT_THROW(requireWritable(folder.path()), InvalidInput);
  EXPECT_THROW(requireWritable("/dev/null"), InvalidInput);  // would be replaced by a file
  fs::create_symlink(folder / "a.txt", folder / "link.txt");
  writeWhole(folder / "link.txt", "through");
  EXPECT_TRUE(fs::is_symlink(folder / "link.txt"));
  EXPECT_EQ(fs::file_size(folder / "a.txt"), 7u);
  fs::remove(folder / "link.txt");
  EXPECT_EQ(folder.files(), 1);
}
