#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "core/random.hpp"
#include "plants/random_leaves.hpp"
#include "render/reference/forward_trace.hpp"

// The open forest of RAMI4PILPS (Widlowski et al. 2011): spherical crowns of small leaves in all directions, at random
// places where none meets another.
using namespace sunfleck;
namespace fs = std::filesystem;

namespace {

constexpr float kDegree = std::numbers::pi_v<float> / 180.f;
const fs::path kForest = fs::path(SUNFLECK_SOURCE_DIR) / "../shared/reference/rami4pilps_open_forest.json";

constexpr float kRadius = 5.f, kMiddle = 9.f, kPeriod = 250.f;                   // of the crowns and the stand [m]
constexpr double kCrownIndex = 5.;                                               // leaf area over a crown's shadow [1]
const double kCrownArea = std::numbers::pi * double{kRadius} * double{kRadius};  // of that shadow [m^2]

int crownsFor(double cover) {
  return static_cast<int>(std::lround(cover * double{kPeriod} * double{kPeriod} / kCrownArea));
}

// Square leaves of this side. A speck below keeps the ground where it is: at 0.
TreeMesh crown(float leaf_side, std::uint64_t seed) {
  const int leaves = static_cast<int>(std::lround(kCrownIndex * kCrownArea / std::pow(double{leaf_side}, 2)));
  TreeMesh mesh = randomCrown({.size = glm::vec3(2.f * kRadius), .leaf_side = leaf_side, .leaves = leaves}, seed);
  for (glm::vec3& vertex : mesh.vertices) vertex.z += kMiddle;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const glm::vec3& corner : {glm::vec3(0.f), glm::vec3(1e-3f, 0.f, 0.f), glm::vec3(0.f, 1e-3f, 0.f)})
    mesh.vertices.push_back(corner);
  mesh.leaf_triangles.push_back({first, first + 1, first + 2});
  mesh.patch_of_triangle.push_back(TreeMesh::kNoPatch);
  finish(mesh, "crown");
  return mesh;
}

// Crowns of both kinds, each turned by chance, thrown one after the other where no other stands.
Stand placedAtRandom(int crowns, std::uint64_t seed) {
  Stand stand{.trees = {}, .period = glm::vec2(kPeriod)};
  Random random(seed, 0);
  const auto meets = [](const glm::vec3& a, const glm::vec3& b) {
    glm::vec2 apart(a - b);
    apart -= kPeriod * glm::round(apart / kPeriod);
    return glm::length(apart) < 2.f * kRadius;
  };
  while (static_cast<int>(stand.trees.size()) < crowns) {
    const glm::vec3 place(kPeriod * random.uniform(), kPeriod * random.uniform(), 0.f);
    bool free = true;
    for (const Placement& other : stand.trees) free = free && !meets(place, other.position);
    if (free)
      stand.trees.push_back({.position = place,
                             .rotation = 2.f * std::numbers::pi_v<float> * random.uniform(),
                             .kind = static_cast<std::uint32_t>(stand.trees.size() % 2)});
  }
  return stand;
}

// Mean and spread over placements of what each found.
struct Spread {
  double sum = 0., squares = 0., variance = 0.;
  int count = 0;
  void add(const Estimate& found) {
    sum += found.value;
    squares += found.value * found.value;
    variance += found.standard_error * found.standard_error;
    ++count;
  }
  double mean() const { return sum / count; }
  double deviation() const { return std::sqrt(std::max(0., (squares - sum * sum / count) / (count - 1))); }
  double noise() const { return std::sqrt(variance) / count; }  // of the mean, by Monte Carlo
};

int numberFrom(const char* variable, int otherwise) {
  const char* const text = std::getenv(variable);
  return text ? std::atoi(text) : otherwise;
}

}  // namespace

// Check direct light under a sun overhead, where no crown shades another: 1 - c (1 - <exp(-tau)>), with tau of a chord
// through a ball of leaves G = 1/2, whose mean transmission is 2 (1 - (1 + x) exp(-x)) / x^2 for x = tau of a diameter.
// Two crowns are one draw of that medium: gaps between 2 x 16,000 shadows of leaves, 0.005 m^2 each, scatter by 0.0009
// of the light.
TEST(R1_RamiForest, SunOverheadPassesAsThroughBallsOfLeaves) {
  const TreeMesh a = crown(0.1f, 1), b = crown(0.1f, 2);
  const std::array<const TreeMesh*, 2> kinds{&a, &b};
  const double density = kCrownIndex * kCrownArea / (4. / 3. * std::numbers::pi * std::pow(double{kRadius}, 3));
  const double x = 0.5 * density * 2. * double{kRadius};
  const double passing = 2. * (1. - (1. + x) * std::exp(-x)) / (x * x);
  const int crowns = crownsFor(0.5);
  const double cover = crowns * kCrownArea / (double{kPeriod} * double{kPeriod});
  const RayScene scene(kinds, placedAtRandom(crowns, 3), true);
  const ForwardResult result = traceForward(scene, {.leaf = {0.f, 0.f}}, {.paths = 1 << 17});
  EXPECT_NEAR(result.arriving_ground_direct.value, 1. - cover * (1. - passing),
              5. * std::hypot(0.0009, result.arriving_ground_direct.standard_error));
}

// Check absorbed, reflected and transmitted light of every cover and ground under the sun at 27 degrees within 0.003 of
// the published figures, on average over placements of the crowns, as theirs is not published. Over snow, between which
// and the denser crowns light goes to and fro, ours are off by up to 0.0067 (docs/MONTE_CARLO.md says what is known of
// it); 0.0085 adds three times the 0.0006 by which the mean of four placements scatters. At 83 degrees, where a crown's
// shadow is 80 m long, it is a check of order alone. SUNFLECK_FOREST_PLACEMENTS and SUNFLECK_FOREST_PATHS make the
// figures of docs/MONTE_CARLO.md.
TEST(R1_RamiForest, MeetsThePublishedPartitioning) {
  if (!fs::exists(kForest)) GTEST_SKIP() << "the published figures are not beside the repository";
  const nlohmann::json forest = nlohmann::json::parse(std::ifstream(kForest));
  const nlohmann::json& about = forest.at("scene");
  const LeafOptics leaf{.reflectance = about.at("leaf_R").get<float>(),
                        .transmittance = about.at("leaf_T").get<float>()};
  const std::array<std::string, 3> grounds{"BLK", "MED", "SNW"}, shares{"absorbed", "reflected", "transmitted"};
  const int placements = numberFrom("SUNFLECK_FOREST_PLACEMENTS", 4);
  const auto paths = static_cast<std::uint64_t>(numberFrom("SUNFLECK_FOREST_PATHS", 1 << 16));
  const TreeMesh a = crown(0.1f, 1), b = crown(0.1f, 2);
  const std::array<const TreeMesh*, 2> kinds{&a, &b};
  for (const auto& [index, values] : forest.at("values").items()) {
    const int crowns = crownsFor(std::stod(index) / kCrownIndex);
    std::array<std::array<std::array<Spread, 3>, 3>, 2> found;  // by sun, ground and share
    for (int placement = 0; placement < placements; ++placement) {
      const auto seed = static_cast<std::uint64_t>(placement) + 1;
      const RayScene scene(kinds, placedAtRandom(crowns, seed), true);
      for (std::size_t sun = 0; sun < 2; ++sun) {
        std::vector<TraceLight> bands;
        for (const std::string& ground : grounds)
          bands.push_back({.sun = sunlight((sun == 0 ? 27.f : 83.f) * kDegree, 0.f),
                           .leaf = leaf,
                           .ground_albedo = about.at("soil").at(ground).get<float>()});
        const auto results = traceForwardBands(scene, bands, {.paths = sun == 0 ? paths : paths / 2, .seed = seed});
        for (std::size_t ground = 0; ground < grounds.size(); ++ground) {
          const ForwardResult& result = results[ground];
          const std::array parts{result.absorbed_leaves, result.reflected, result.arriving_ground};
          for (std::size_t share = 0; share < parts.size(); ++share) found[sun][ground][share].add(parts[share]);
        }
      }
    }
    for (std::size_t sun = 0; sun < 2; ++sun)
      for (std::size_t ground = 0; ground < grounds.size(); ++ground)
        for (std::size_t share = 0; share < shares.size(); ++share) {
          const double expected = values.at(grounds[ground]).at(share).at(sun).get<double>();
          const Spread& spread = found[sun][ground][share];
          const std::string row = fmt::format(
              "leaf area index {}, ground {}, sun {}, {:<11}: {:.4f}, published {:.4f}, {:+.4f}; noise {:.4f}, one "
              "placement {:.4f}",
              index, grounds[ground], sun == 0 ? 27 : 83, shares[share], spread.mean(), expected,
              spread.mean() - expected, spread.noise(), spread.deviation());
          fmt::print("{}\n", row);
          const bool snow_under_many = crowns > 200 && grounds[ground] == "SNW";
          const double allowed = sun == 1 ? 0.05 : snow_under_many ? 0.0085 : 0.003;
          EXPECT_NEAR(spread.mean(), expected, allowed) << row;
        }
  }
}
