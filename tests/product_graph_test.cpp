#include "grid/product_graph.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <set>
#include <stdexcept>
#include <vector>

namespace {

using namespace sunfleck;

// Two products of three members each, where member i of the later one follows from member i of the earlier.
class ProductGraphTest : public testing::Test {
 protected:
  ProductGraphTest() : maps(graph.add("maps")), depths(graph.add("depths")) {
    graph.follows(depths, maps, [this](std::size_t member, const ProductGraph::Mark& mark) {
      ++asked;
      mark(member);
    });
    graph.resize(maps, 3);
    graph.resize(depths, 3);
  }
  std::vector<std::size_t> brought(ProductGraph::Product product, std::vector<std::size_t> members) {
    std::vector<char> made(3, 0);
    graph.bring(product, members, [&](std::size_t member) { made[member] = 1; });
    std::vector<std::size_t> which;
    for (std::size_t i = 0; i < made.size(); ++i)
      if (made[i]) which.push_back(i);
    return which;
  }

  ProductGraph graph;
  ProductGraph::Product maps, depths;
  int asked = 0;  // how often the followers of a map were asked for
};

using Members = std::vector<std::size_t>;

// Check that new members are stale, that only those asked for are made, and that a second time none is.
TEST_F(ProductGraphTest, MakesWhatIsStaleAndAskedFor) {
  EXPECT_EQ(brought(maps, {0, 2}), (Members{0, 2}));
  EXPECT_EQ(brought(maps, {0, 1, 2}), (Members{1}));
  EXPECT_EQ(brought(maps, {0, 1, 2}), Members{});
  const ProductCost cost = graph.costs()[maps];
  EXPECT_EQ(cost.name, "maps");
  EXPECT_EQ(cost.made, 3u);
  EXPECT_EQ(cost.reused, 2u + 3u);
  EXPECT_GE(cost.seconds, 0.);
  graph.resize(maps, 4);
  EXPECT_FALSE(graph.stale(maps, 2));
  EXPECT_TRUE(graph.stale(maps, 3));
}

// Check that staleness passes to what follows, once: what is stale already has stale followers.
TEST_F(ProductGraphTest, PassesStalenessOnOnce) {
  brought(maps, {0, 1, 2});
  brought(depths, {0, 1, 2});
  graph.touch(maps, 1);
  graph.touch(maps, 1);
  EXPECT_EQ(asked, 1);
  EXPECT_EQ(brought(depths, {0, 2}), Members{});
  EXPECT_EQ(brought(maps, {0, 1, 2}), (Members{1}));
  EXPECT_EQ(brought(depths, {0, 1, 2}), (Members{1}));
  graph.touch(depths, 0);  // not the other way
  EXPECT_FALSE(graph.stale(maps, 0));
  graph.touchAll(maps);
  EXPECT_EQ(brought(depths, {0, 1, 2}), (Members{0, 1, 2}));
}

// Check that each making has a revision of its own, and that what is not made keeps its.
TEST_F(ProductGraphTest, NumbersEachMaking) {
  EXPECT_EQ(graph.revision(maps, 0), 0u);
  brought(maps, {0, 1, 2});
  brought(depths, {0, 1});
  std::set<std::uint64_t> seen{0};
  for (std::size_t member = 0; member < 3; ++member) EXPECT_TRUE(seen.insert(graph.revision(maps, member)).second);
  for (std::size_t member = 0; member < 2; ++member) EXPECT_TRUE(seen.insert(graph.revision(depths, member)).second);
  EXPECT_EQ(graph.revision(depths, 2), 0u);
  const std::uint64_t kept = graph.revision(maps, 0);
  graph.touch(maps, 1);
  EXPECT_FALSE(seen.insert(graph.revision(maps, 1)).second);  // what is there is what was made
  brought(maps, {0, 1, 2});
  EXPECT_TRUE(seen.insert(graph.revision(maps, 1)).second);
  EXPECT_EQ(graph.revision(maps, 0), kept);
}

// Check that an end by the caller keeps what is made, leaves the rest stale, and that progress rises to 1.
TEST_F(ProductGraphTest, KeepsWhatIsMadeWhenInterrupted) {
  graph.resize(maps, 1000);
  Members all(1000);
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::atomic<std::size_t> made{0};
  const auto make = [&](std::size_t) { ++made; };
  double last = 0.;
  EXPECT_THROW(graph.bring(maps, all, make, [&](double done) { return (last = done) < 0.5; }), std::runtime_error);
  EXPECT_GE(last, 0.5);
  EXPECT_LT(made, 600u);
  EXPECT_EQ(graph.costs()[maps].made, made);
  last = 0.;
  graph.bring(maps, all, make, [&](double done) {
    EXPECT_GT(done, last);
    last = done;
    return true;
  });
  EXPECT_EQ(made, 1000u);
  EXPECT_EQ(last, 1.);
}

}  // namespace
