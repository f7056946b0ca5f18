// Check that threads of the field do not spin: while something else keeps one core busy, they go on on the others.
#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <functional>
#include <thread>

#include "core/elapsed.hpp"
#include "field/clumping.hpp"
#include "field/grid_field.hpp"
#include "field/leaf_field.hpp"
#include "plants/random_leaves.hpp"

using namespace sunfleck;

namespace {

// The cores that this process may run on.
std::vector<int> cores() {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  sched_getaffinity(0, sizeof(allowed), &allowed);
  std::vector<int> numbers;
  for (int core = 0; core < CPU_SETSIZE; ++core)
    if (CPU_ISSET(static_cast<std::size_t>(core), &allowed)) numbers.push_back(core);
  return numbers;
}

// Keeps a core busy as long as it lives.
class Neighbour {
 public:
  explicit Neighbour(int core)
      : thread_([this, core] {
          cpu_set_t one;
          CPU_ZERO(&one);
          CPU_SET(static_cast<std::size_t>(core), &one);
          pthread_setaffinity_np(pthread_self(), sizeof(one), &one);
          while (!over_.load(std::memory_order_relaxed)) {
          }
        }) {}
  ~Neighbour() {
    over_ = true;
    thread_.join();
  }

 private:
  std::atomic<bool> over_ = false;
  std::thread thread_;
};

double secondsOf(const std::function<void()>& work) {
  const Elapsed elapsed;
  work();
  return elapsed.seconds();
}

// How many times as long it takes beside a busy core as without, by turns: the median of several pairs, so that what
// others do on this machine meanwhile does not count.
double slowdown(const std::function<void()>& work) {
  const int core = cores().front();
  work();
  std::vector<double> ratios;
  for (int round = 0; round < 15; ++round) {
    const double alone = secondsOf(work);
    const Neighbour neighbour(core);
    ratios.push_back(secondsOf(work) / alone);
  }
  std::nth_element(ratios.begin(), ratios.begin() + 7, ratios.end());
  return ratios[7];
}

// A core of two that is shared evenly with a neighbour leaves 1.5, so 1.33 times the time where work is shared as
// threads are ready for it, and twice the time where the others wait for what a displaced thread was at; the rest is
// for chance. Threads that spin while they wait take a slice of the scheduler's, some milliseconds, for each of
// hundreds of steps of a fraction of one: several times the time.
constexpr double kMost = 2.5;

}  // namespace

TEST(F4_LeafField, DoesNotSpin) {
  if (cores().size() < 2) GTEST_SKIP() << "a neighbour on the only core halves its time";
  LeafField field;
  field.setStand(std::array{std::shared_ptr<const TreeMesh>(std::make_shared<TreeMesh>(randomCrown({}, 1)))}, Stand{});
  FieldLighting lighting{.suns = {FieldSun{}}, .kinds = {FieldKind{}}};
  float albedo = 0.9f;
  const double ratio = slowdown([&] {
    for (int i = 0; i < 5; ++i) {
      albedo += 1e-4f;  // optics that it has not solved yet
      lighting.kinds[0].leaf.fill({.reflectance = 0.5f * albedo, .transmittance = 0.5f * albedo});
      field.solve(lighting);
    }
  });
  RecordProperty("slowdown", std::to_string(ratio));
  EXPECT_LT(ratio, kMost);
}

TEST(F17_GridField, DoesNotSpin) {
  if (cores().size() < 2) GTEST_SKIP() << "a neighbour on the only core halves its time";
  const TreeMesh mesh = randomCrown({}, 1);
  const FieldElements elements = fieldElements(mesh);
  const PlacedElements tree{.mesh = &mesh, .elements = &elements};
  GridField field(cellMedium({&tree, 1}), std::array{0.9f});
  const float dark = 0.f;
  const GridLight light{.optics = {{{.leaf = {0.475f, 0.475f}}}},
                        .direct = field.sunThroughCells({0.f, 0.f, -1.f}).direct,
                        .entering = field.evenSky({&dark, 1}, {&dark, 1}, {})};
  const double ratio = slowdown([&] {
    for (int i = 0; i < 5; ++i) field.solve(light);
  });
  RecordProperty("slowdown", std::to_string(ratio));
  EXPECT_LT(ratio, kMost);
}
