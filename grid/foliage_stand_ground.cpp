#include <tbb/parallel_for.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <numbers>

#include "grid/foliage_stand.hpp"
#include "spp/slab.hpp"
#include "spp/slab_arrays.hpp"

// (D12) What reaches the ground.
namespace sunfleck {
namespace {

constexpr int kTile = 8;     // cells to a side that look for trees together
constexpr float kMu0 = 1.f;  // the slab's normal is the light's axis

}  // namespace

void FoliageStand::prepareGround(const Progress& progress) {
  prepareDepths({}, !lights_.empty(), progress);
  std::vector<std::size_t> members;
  for (std::size_t i = 0; i <= lights_.size(); ++i) members.push_back(i);
  graph_.bring(
      ground_, members, [&](std::size_t i) { makeGround(i); }, progress);
}

// Of the sky (member 0) or of a light. Lines through a tile's cells meet the same trees.
void FoliageStand::makeGround(std::size_t member) {
  const GroundGrid& ground = ground_grid_;
  const auto count = static_cast<std::size_t>(ground.size.x) * static_cast<std::size_t>(ground.size.y);
  std::vector<glm::vec3>& result = member == 0 ? ground_sky_ : ground_shares_[member - 1];
  result.assign(count, glm::vec3(0.f));
  const std::vector<std::size_t> standing = standingPrototypes();
  // Which of the pictures is looked at: that for the widest cells.
  const auto seen_from =
      static_cast<std::size_t>(std::max_element(seen_from_.begin(), seen_from_.end()) - seen_from_.begin());

  struct Line {
    std::size_t axis;
    Direction along;
    glm::vec3 weight;  // of what comes along it, per band
  };
  std::vector<Line> lines;
  if (member == 0) {
    const float solid_angle = 4.f * std::numbers::pi_v<float> / static_cast<float>(sky_.size());
    const std::vector<Direction> directions = sampleDirections();
    for (std::size_t j = 0; j < directions.size(); ++j)
      if (directions[j].z > 0.f && sky_[j] != glm::vec3(0.f))
        lines.push_back({j / 2, effort_.axes[j / 2], solid_angle * directions[j].z * sky_[j]});
  } else {
    lines.push_back({effort_.axes.size() + member - 1, lights_[member - 1], glm::vec3(1.f)});
  }

  Bounds tile;  // about its middle, and the leaves of any kind less its points
  tile.include(glm::vec3(-0.5f * kTile * ground.cell_size, 0.f));
  tile.include(glm::vec3(0.5f * kTile * ground.cell_size, 0.f));
  Bounds met;
  for (const std::size_t p : standing) {
    const CellGrid& cells = prototypes_[p].cells;
    const glm::vec3 blurred(2.f * std::max(cells.cell_size, seen_from_[seen_from]));
    met.include(Bounds{cells.leaves.low - blurred - tile.high, cells.leaves.high + blurred - tile.low});
  }
  const glm::ivec2 tiles = (ground.size + kTile - 1) / kTile;
  tbb::parallel_for(0, tiles.x * tiles.y, [&](int number) {
    const glm::ivec2 first = kTile * glm::ivec2(number % tiles.x, number / tiles.x);
    const glm::ivec2 end = glm::min(first + kTile, ground.size);
    const glm::vec3 middle(ground.low + ground.cell_size * (glm::vec2(first) + 0.5f * kTile), ground.height);
    constexpr std::size_t kCells = kTile * kTile;
    std::array<float, kCells> thickness, down, up;
    std::array<glm::vec3, kCells> arriving;
    std::vector<std::array<std::uint32_t, kCells>> steps(prototypes_.size());  // of each kind
    for (const Line& line : lines) {
      for (const std::size_t p : standing) steps[p].fill(0);
      index_.along(middle, met, line.along, [&](std::uint32_t tree, const glm::vec3& displacement) {
        const std::size_t p = placed_[tree].prototype;
        const TreeDepths& depths = *prototypes_[p].axes[line.axis];
        const Axes& axes = depths.axes();
        const glm::vec3 from = -displacement;  // of the tile's middle in the prototype's frame
        const glm::vec2 corner(glm::dot(from, axes.right), glm::dot(from, axes.up));
        for (std::size_t i = 0; i < kCells; ++i) {
          const glm::vec2 beside =
              ground.cell_size * (glm::vec2(i % kTile, i / kTile) + 0.5f - 0.5f * static_cast<float>(kTile));
          const glm::vec2 at =
              corner + beside.x * glm::vec2(axes.right.x, axes.up.x) + beside.y * glm::vec2(axes.right.y, axes.up.y);
          std::uint32_t& sum = steps[p][i];
          sum = std::min(sum + depths.thickness(seen_from, at), kDeepest);
        }
      });
      arriving.fill(line.weight);
      for (const std::size_t p : standing) {
        if (std::all_of(steps[p].begin(), steps[p].end(), [](std::uint32_t of) { return of == 0; })) continue;
        for (std::size_t i = 0; i < kCells; ++i) thickness[i] = static_cast<float>(steps[p][i]) / kDepthSteps;
        for (std::size_t band = 0; band < kBands; ++band) {
          const LeafOptics& leaf = prototypes_[p].leaf[band];
          if (band == 0 || !(leaf == prototypes_[p].leaf[band - 1]))
            spp::sppPowers(thickness, thickness, kMu0, leaf.albedo(),
                           spp::sphericalLeafForwardShare(leaf.reflectance, leaf.transmittance), down, up);
          for (std::size_t i = 0; i < kCells; ++i) arriving[i][static_cast<int>(band)] *= down[i];
        }
      }
      for (int y = first.y; y < end.y; ++y)
        for (int x = first.x; x < end.x; ++x)
          result[static_cast<std::size_t>(y) * static_cast<std::size_t>(ground.size.x) + static_cast<std::size_t>(x)] +=
              arriving[static_cast<std::size_t>((y - first.y) * kTile + x - first.x)];
    }
  });
}

}  // namespace sunfleck
