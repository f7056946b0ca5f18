#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cstring>
#include <glm/geometric.hpp>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

#include "core/random.hpp"
#include "grid/foliage_stand.hpp"
#include "leaf_shapes.hpp"
#include "plants/random_leaves.hpp"

namespace {

using namespace sunfleck;
using Mesh = std::shared_ptr<const TreeMesh>;

FoliageEffort coarse() {
  return {.axes = {{0.f, 0.f, -1.f}, {1.f, 0.f, 0.f}, {0.f, 0.6f, 0.8f}, glm::normalize(glm::vec3(-0.4f, 0.3f, -0.5f))},
          .sample_resolution = 20,
          .light_resolution = 24,
          .cells = 4};
}

// Horizontal squares of side 0.5 above each other: a line down through two such trees crosses more than 128 leaves.
Mesh pile(int leaves) {
  auto mesh = std::make_shared<TreeMesh>();
  for (int i = 0; i < leaves; ++i)
    shapes::addPolygon(*mesh, mesh->leaf_triangles,
                       shapes::rectangle({0.1f, 0.f, static_cast<float>(i) / static_cast<float>(leaves)},
                                         {0.25f, 0.f, 0.f}, {0.f, 0.25f, 0.f}));
  finish(*mesh, "pile");
  return mesh;
}

Mesh crown(glm::vec3 size, int leaves, std::uint64_t seed) {
  return std::make_shared<TreeMesh>(randomCrown({.size = size, .leaf_side = 0.2f, .leaves = leaves}, seed));
}

struct Tree {
  std::size_t prototype;
  glm::vec3 position;
};

// What a stand should be now, told apart from how it became so.
struct Description {
  std::vector<Mesh> meshes;
  std::vector<std::array<LeafOptics, kBands>> leaves;
  std::vector<std::optional<Tree>> trees;
  std::optional<glm::vec2> period;
  std::vector<Direction> lights;
  std::vector<glm::vec3> sky;
};

// A stand made afresh, with its trees added from the last to the first; and the number there of each tree here.
struct Afresh {
  FoliageStand stand{coarse()};
  std::vector<std::size_t> number;

  explicit Afresh(const Description& is) : number(is.trees.size()) {
    for (std::size_t p = 0; p < is.meshes.size(); ++p) {
      stand.addPrototype(is.meshes[p]);
      stand.setLeaf(p, is.leaves[p]);
    }
    for (std::size_t i = is.trees.size(); i-- > 0;)
      if (is.trees[i]) number[i] = stand.add(is.trees[i]->prototype, is.trees[i]->position);
    stand.setPeriod(is.period);
    stand.setLights(is.lights);
    stand.setSky(is.sky);
    stand.prepareCompensation(stand.allInstances());
    stand.prepareSkyLight(stand.allInstances());
  }
};

template <typename T>
bool sameBits(std::span<const T> a, std::span<const T> b) {
  return a.size() == b.size() && !a.empty() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

void expectSameDepths(const FoliageStand& stand, std::size_t i, const FoliageStand& other, std::size_t j) {
  for (std::size_t direction = 0; direction < stand.sampleDirections().size(); ++direction)
    ASSERT_TRUE(sameBits(stand.depths(i, direction), other.depths(j, direction))) << "direction " << direction;
}

void expectSameLight(const FoliageStand& stand, std::size_t i, const FoliageStand& other, std::size_t j,
                     std::size_t lights) {
  expectSameDepths(stand, i, other, j);
  for (std::size_t light = 0; light < lights; ++light) {
    ASSERT_TRUE(sameBits(stand.lightDepths(i, light), other.lightDepths(j, light))) << "light " << light;
    ASSERT_TRUE(sameBits(stand.depthsBeyond(i, light), other.depthsBeyond(j, light))) << "light " << light;
    ASSERT_TRUE(sameBits(stand.compensation(i, light), other.compensation(j, light))) << "light " << light;
  }
}

// A stand and what it should be, changed together at random.
class Gardener {
 public:
  explicit Gardener(std::uint64_t seed, std::optional<glm::vec2> period) : random_(seed, 0) {
    for (int p = 0; p < 3; ++p) addPrototype();
    for (int i = 0; i < 7; ++i) add();
    period_ = is_.period = period;
    stand_.setPeriod(period);
    is_.sky.assign(2 * coarse().axes.size(), glm::vec3(0.f));
  }

  void edit() {
    const std::size_t kind = below(24);
    if (kind < 9) return move();
    if (kind < 11) return add();
    if (kind < 13) return remove();
    if (kind < 16) return turnLights();
    if (kind < 18) return changeSky();
    if (kind < 20) return changeLeaf();
    if (kind < 21) return replace();
    if (kind < 22) return changePeriod();
    if (kind < 23) return look();
    if (is_.meshes.size() < 5) return addPrototype();
  }

  // Prepares some trees or all, and compares them with those of a stand made afresh.
  void check(bool all) {
    std::vector<std::size_t> those = stand_.allInstances();
    if (!all) std::erase_if(those, [&](std::size_t) { return below(2) == 0; });
    if (!all && below(4) == 0) interrupt(those);
    const Afresh afresh(is_);
    const bool lit = all || below(3) > 0, under_sky = all || below(3) > 0;
    if (lit) {
      stand_.prepareCompensation(those);
      for (const std::size_t i : those) expectSameLight(stand_, i, afresh.stand, afresh.number[i], is_.lights.size());
    }
    if (under_sky) {
      stand_.prepareSkyLight(those);
      for (const std::size_t i : those) {
        expectSameDepths(stand_, i, afresh.stand, afresh.number[i]);
        ASSERT_TRUE(sameBits(stand_.skyLight(i), afresh.stand.skyLight(afresh.number[i])));
      }
    }
    if (!lit && !under_sky) return;
    for (const std::size_t i : those)
      for (std::size_t direction = 0; direction < is_.sky.size(); ++direction)
        for (const FixedDepth depth : stand_.depths(i, direction)) saturated_ += depth == kDeepest;
  }

  const FoliageStand& stand() const { return stand_; }
  std::size_t saturated() const { return saturated_; }  // depths met so far that are cut short

 private:
  std::size_t below(std::size_t bound) { return random_.bits() % bound; }
  float between(float low, float high) { return low + (high - low) * random_.uniform(); }
  // Often straight above, below or beside another tree, and now and then in it.
  glm::vec3 place() {
    const auto step = [&] { return 0.75f * static_cast<float>(below(4)); };
    glm::vec3 position(step(), step(), step());
    if (below(2) == 0) position += glm::vec3(between(-0.5f, 0.5f), between(-0.5f, 0.5f), between(-0.5f, 0.5f));
    return position;
  }
  Mesh mesh() {
    if (is_.meshes.empty()) return pile(200);  // deeper than depths are told
    if (below(3) == 0) return pile(80 + static_cast<int>(below(120)));
    return crown({between(0.7f, 2.5f), between(0.7f, 2.5f), between(0.7f, 2.f)}, 20 + static_cast<int>(below(60)),
                 random_.bits());
  }
  std::optional<std::size_t> someTree() {
    const std::vector<std::size_t> present = stand_.allInstances();
    if (present.empty()) return std::nullopt;
    return present[below(present.size())];
  }

  void addPrototype() {
    is_.meshes.push_back(mesh());
    is_.leaves.push_back({});
    stand_.addPrototype(is_.meshes.back());
  }
  void replace() {
    const std::size_t p = below(is_.meshes.size());
    is_.meshes[p] = mesh();
    stand_.replacePrototype(p, is_.meshes[p]);
  }
  void add() {
    if (stand_.allInstances().size() >= 12) return;
    is_.trees.push_back(Tree{below(is_.meshes.size()), place()});
    EXPECT_EQ(stand_.add(is_.trees.back()->prototype, is_.trees.back()->position), is_.trees.size() - 1);
  }
  void move() {
    const auto i = someTree();
    if (!i) return;
    is_.trees[*i]->position = place();
    stand_.move(*i, is_.trees[*i]->position);
  }
  void remove() {
    const auto i = someTree();
    if (!i) return;
    is_.trees[*i].reset();
    stand_.remove(*i);
  }
  void turnLights() {
    if (below(3) == 0 || is_.lights.empty()) is_.lights.resize(below(4), {0.f, 0.f, -1.f});
    if (!is_.lights.empty())
      is_.lights[below(is_.lights.size())] =
          below(3) == 0 ? Direction(0.f, 0.f, -1.f) : sunlight(between(0.f, 1.57f), between(0.f, 6.28f));
    stand_.setLights(is_.lights);
  }
  void changeSky() {
    for (glm::vec3& radiance : is_.sky)
      if (below(2) == 0) radiance = below(3) == 0 ? glm::vec3(0.f) : glm::vec3(between(0.f, 1.f), 0.4f, 0.1f);
    stand_.setSky(is_.sky);
  }
  void changeLeaf() {
    const std::size_t p = below(is_.meshes.size());
    for (LeafOptics& leaf : is_.leaves[p])
      if (below(2) == 0) leaf = {.reflectance = between(0.f, 0.5f), .transmittance = between(0.f, 0.5f)};
    stand_.setLeaf(p, is_.leaves[p]);
  }
  void changePeriod() {
    if (period_) {
      is_.period = glm::vec2(between(1.5f, 4.f), period_->y);
      stand_.setPeriod(is_.period);
    }
  }
  // Products that may be looked at by themselves.
  void look() {
    const std::size_t p = below(is_.meshes.size());
    if (is_.lights.empty() || below(2) == 0)
      stand_.cells(p);
    else
      stand_.lightMap(p, below(is_.lights.size()));
  }
  void interrupt(std::span<const std::size_t> those) {
    const double end = random_.uniformDouble();
    try {
      stand_.prepareCompensation(those, [end](double done) { return done < end; });
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "interrupted");
    }
  }

  Random random_;
  FoliageStand stand_{coarse()};
  Description is_;
  std::optional<glm::vec2> period_;
  std::size_t saturated_ = 0;
};

void garden(std::uint64_t seed, std::optional<glm::vec2> period, int steps) {
  Gardener gardener(seed, period);
  for (int step = 0; step < steps; ++step) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", step " + std::to_string(step));
    const auto edits = 1 + step % 3;
    for (int i = 0; i < edits; ++i) gardener.edit();
    gardener.check(step % 8 == 7);
    if (testing::Test::HasFatalFailure()) return;
  }
  // The series is worth its time only if sums were cut short, and were changed in place.
  EXPECT_GT(gardener.saturated(), 0u);
  for (const ProductCost& cost : gardener.stand().costs())
    if (cost.name == "depths") {
      EXPECT_GT(cost.adjusted, 0u);
    }
}

// (D4) (D5) (D10) Check that a stand after any series of changes holds the bits of one made afresh, in which the trees
// are added in the opposite order.
TEST(D4_FoliageStandHistory, LeavesNoTrace) {
  for (std::uint64_t seed = 0; seed < 3; ++seed) garden(seed, std::nullopt, 50);
}

TEST(D4_FoliageStandHistory, LeavesNoTraceInAPeriodicStand) {
  for (std::uint64_t seed = 0; seed < 2; ++seed) garden(100 + seed, glm::vec2(2.5f, 2.f), 40);
}

// (D4) (D5) (D10) Check that the number of threads changes no bit.
TEST(D4_FoliageStandHistory, IsTheSameForAnyNumberOfThreads) {
  Description is{.meshes = {crown({1.5f, 1.5f, 2.f}, 200, 1), pile(150)},
                 .leaves = {{}, {}},
                 .period = glm::vec2(6.f, 6.f),
                 .lights = {{0.f, 0.f, -1.f}, sunlight(0.8f, 1.f)},
                 .sky = std::vector<glm::vec3>(8, glm::vec3(1.f, 0.5f, 0.2f))};
  for (std::size_t i = 0; i < 16; ++i)
    is.trees.push_back(Tree{i % 2, glm::vec3(1.3f * static_cast<float>(i % 4), 1.1f * static_cast<float>(i / 4), 0.f)});
  const auto with = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return std::make_unique<Afresh>(is);
  };
  const auto one = with(1), two = with(2);
  for (std::size_t i = 0; i < is.trees.size(); ++i) {
    expectSameLight(one->stand, one->number[i], two->stand, two->number[i], is.lights.size());
    EXPECT_TRUE(sameBits(one->stand.skyLight(one->number[i]), two->stand.skyLight(two->number[i])));
  }
}

// (D4) Check that more trees on a line than whole numbers of 32 bits could add up are as deep as any depth told, and
// that those who come and go leave no trace: 33,000 trees of 128 leaves, met along the line they stand on.
TEST(D4_FoliageStandHistory, HoldsManyTreesOnALine) {
  FoliageStand stand({.axes = {{0.f, 0.f, 1.f}}, .sample_resolution = 2, .light_resolution = 2, .cells = 1});
  stand.addPrototype(pile(128));
  for (int i = 0; i < 33'000; ++i) stand.add(0, {0.f, 0.f, static_cast<float>(i)});
  const std::size_t lowest = 0;
  stand.prepareCompensation(std::span(&lowest, 1));
  EXPECT_TRUE(std::ranges::all_of(stand.depths(0, 0), [](FixedDepth depth) { return depth == kDeepest; }));
  EXPECT_TRUE(std::ranges::all_of(stand.depths(0, 1), [](FixedDepth depth) { return depth < kDeepest; }));
}

// (D4) Check that the time of sums that follow a moved tree stands with the depths that they are part of: with only a
// light's depths to adjust, at none of the sample directions.
TEST(D4_FoliageStandHistory, TellsWhatAdjustedTheTime) {
  FoliageStand stand({.axes = {{0.f, 0.f, 1.f}}, .sample_resolution = 8, .light_resolution = 8, .cells = 2});
  stand.addPrototype(crown(glm::vec3(1.f), 200, 1));
  for (int i = 0; i < 12; ++i) stand.add(0, {12.f * static_cast<float>(i), 0.f, 0.f});
  const Direction level{1.f, 0.f, 0.f};  // on which all trees stand; along the sample axis none meets another
  stand.setLights(std::span(&level, 1));
  stand.prepareCompensation(stand.allInstances());
  const std::size_t others = 0;
  const auto cost = [&](const std::string& name) {
    const std::vector<ProductCost> costs = stand.costs();
    return *std::ranges::find(costs, name, &ProductCost::name);
  };
  const ProductCost samples = cost("depths"), lights = cost("light depths");
  stand.move(11, {133.f, 0.f, 0.f});
  stand.prepareCompensation(std::span(&others, 1));  // of the moved tree itself nothing is made
  EXPECT_EQ(cost("depths").made, samples.made);
  EXPECT_EQ(cost("depths").adjusted, samples.adjusted);
  EXPECT_EQ(cost("depths").seconds, samples.seconds);
  EXPECT_EQ(cost("light depths").adjusted, lights.adjusted + 11);
  EXPECT_GT(cost("light depths").seconds, lights.seconds);
}

}  // namespace
