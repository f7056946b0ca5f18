#include "field/large_stand.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <numbers>
#include <numeric>

#include "core/available_memory.hpp"
#include "core/require.hpp"
#include "field/field_solver.hpp"
#include "sky/sky_shares.hpp"

namespace sunfleck {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr std::size_t kTogether = 4;    // trees of a kind that are solved side by side
constexpr float kClusterShare = 0.4f;   // side of the cells that gather clusters, in those of the stand [1]
constexpr float kWallPixel = 0.5f;      // of the pictures of light at a tree's walls, in sides of cells [1]
constexpr int kFarGroup = 3;            // cells of clusters along that of a group of a far tree
constexpr double kLightMemory = 0.5e9;  // that light at walls may take at once [byte]

enum Cost : std::size_t { kKinds, kCells, kSun, kCellSolution, kWalls, kTrees, kCosts };

glm::vec3 turned(const glm::vec3& v, float rotation) {
  const float cosine = std::cos(rotation), sine = std::sin(rotation);
  return {cosine * v.x - sine * v.y, sine * v.x + cosine * v.y, v.z};
}

ElementOptics opticsOf(const FieldKind& kind, bool wood, std::size_t band) {
  if (wood) return {kind.wood_reflectance[static_cast<int>(band)], 0.f};
  return {kind.leaf[band].reflectance, kind.leaf[band].transmittance};
}

bool operator==(const ElementOptics& a, const ElementOptics& b) {
  return a.reflectance == b.reflectance && a.transmittance == b.transmittance;
}

}  // namespace

// What of a kind does not depend on where its trees stand.
// Direct light is taken as scattered from all of a side alike, of which near return (F7) would be the other half.
constexpr std::array<float, 2> kNoReturn{};

struct LargeStandField::Kind {
  FieldElements elements;
  std::vector<std::uint32_t> materials;  // 0 of leaves, 1 of wood
  LineExchange exchange;
  OutsideLines outside;
  std::vector<float> per_line;  // irradiance of each element by radiance 1 on one line
  double escape = 0.;           // share of the lines from its leaves that leave the tree
  LeafClusters clusters;
  ClusterGroups groups;
  std::vector<std::uint32_t> group_side;  // of each side of each element
  Bounds box;

  FieldGeometry geometry() const { return {elements, exchange, materials, kNoReturn, false}; }
};

// Trees of a kind that are turned alike.
struct LargeStandField::Turn {
  std::uint32_t kind = 0;
  float rotation = 0.f;
  TurnedClusters clusters;
  Bounds box;                          // of leaves and wood
  std::vector<TreePicture> pictures;   // of each sun
  std::vector<std::uint32_t> nearest;  // of each direction of the exchange, as it is turned, the nearest that is not
};

// What the light of the present suns, sky and optics makes.
struct LargeStandField::Lit {
  std::vector<SunLines> lines;                       // of each sun
  std::vector<std::vector<std::uint32_t>> of_cells;  // of each sun, lines that come to each element's sides
  std::vector<std::vector<std::uint32_t>> shaded;    // of each sun, lines that do not come to each column's ground
  std::vector<std::vector<std::vector<std::uint32_t>>> of_seen;  // of each sun, of each tree, lines to its sides
  std::vector<std::size_t> bands;                                // that differ
  std::array<std::size_t, kBands> as{};                          // of which of those each band is
  std::vector<GridSolution> solutions;                           // of those
  std::vector<std::vector<float>> scattered;  // of those, irradiance of elements' sides by all but the suns
};

LargeStandField::LargeStandField(const LargeStandEffort& effort) : effort_(effort) {
  for (const char* name : {"kinds", "cells", "direct light", "solution on cells", "light at walls", "trees in view"})
    costs_.push_back({.name = name});
}
LargeStandField::~LargeStandField() = default;

std::vector<ProductCost> LargeStandField::costs() const {
  return costs_;
}

void LargeStandField::setStand(std::span<const std::shared_ptr<const TreeMesh>> kinds, const Stand& stand) {
  requireFieldStand(kinds, stand);
  const bool same_kinds = std::ranges::equal(kinds, meshes_);
  if (stand == stand_ && same_kinds) return;
  if (!same_kinds) kinds_.clear();
  meshes_.assign(kinds.begin(), kinds.end());
  stand_ = stand;
  lighting_.reset();
  cells_stale_ = true;
}

void LargeStandField::makeKinds() {
  const Stopwatch watch(costs_[kKinds].seconds);
  kinds_.resize(meshes_.size());
  {
    for (std::size_t i = 0; i < meshes_.size(); ++i) {
      if (std::ranges::none_of(stand_.trees, [&](const Placement& tree) { return tree.kind == i; })) {
        kinds_[i] = nullptr;
        continue;
      }
      if (kinds_[i]) continue;
      Kind& kind = *(kinds_[i] = std::make_unique<Kind>());
      ++costs_[kKinds].made;
      kind.elements = fieldElements(*meshes_[i], effort_.elements);
      kind.exchange = lineExchange(*meshes_[i], kind.elements, std::nullopt, effort_.exchange);
      kind.outside = outsideLines(kind.exchange);
      double from_leaves = 0., outside = 0.;
      for (std::size_t e = 0; e < kind.elements.size(); ++e) {
        const bool wood = e >= kind.elements.leaf_elements;
        kind.materials.push_back(wood ? 1 : 0);
        kind.per_line.push_back(kPi / static_cast<float>(std::max(kind.exchange.lines[e], 1u)));
        from_leaves += (wood ? 1. : 2.) * kind.exchange.lines[e];
        for (std::size_t side = 2 * e; side < 2 * e + (wood ? 1 : 2); ++side)
          outside += static_cast<double>(kind.exchange.first_outside[side + 1] - kind.exchange.first_outside[side]);
      }
      kind.escape = outside / std::max(from_leaves, 1.);
      kind.box = bounds(*meshes_[i]);
    }
  }
  turns_.clear();
  turn_of_tree_.clear();
  std::map<std::pair<std::uint32_t, float>, std::size_t> known;
  for (const Placement& tree : stand_.trees) {
    const auto [place, is_new] = known.try_emplace({tree.kind, tree.rotation}, turns_.size());
    if (is_new) {
      Turn& turn = *turns_.emplace_back(std::make_unique<Turn>());
      turn.kind = tree.kind;
      turn.rotation = tree.rotation;
      const TreeMesh& mesh = *meshes_[tree.kind];
      for (const auto* triangles : {&mesh.leaf_triangles, &mesh.wood_triangles})
        for (const glm::uvec3& t : *triangles)
          for (int corner = 0; corner < 3; ++corner) turn.box.include(turned(mesh.vertices[t[corner]], tree.rotation));
      const std::vector<Direction>& directions = kinds_[tree.kind]->exchange.directions;
      for (const Direction& direction : directions) {
        const glm::vec3 along = turned(direction, tree.rotation);
        // Of those that rise and those that come down each for itself: light of the sky comes down.
        const auto nearness = [&](const Direction& other) {
          return glm::dot(other, along) - (other.z * along.z < 0.f ? 4.f : 0.f);
        };
        turn.nearest.push_back(
            static_cast<std::uint32_t>(std::ranges::max_element(directions, {}, nearness) - directions.begin()));
      }
    }
    turn_of_tree_.push_back(place->second);
  }
}

namespace {

// (F28) Omega of a kind in cells: with which its leaves, all alike bright, lose as much light to the outside as along
// lines. That is the same as to take as much of even light from there.
float clumpingByEscape(const TurnedClusters& alone, const Bounds& box, float side, double escape) {
  const ClusteredTree tree{.turned = &alone, .position = glm::vec3(0.f), .kind = 0};
  const StandMedium medium = standMedium({&tree, 1}, box, side, std::nullopt);
  double area = 0.;
  for (const float of_element : medium.cells.area) area += double{of_element};
  const auto escaping = [&](float omega) {
    GridField field(medium.cells, {&omega, 1});
    const float even = 1.f;
    const GridLight light{.optics = {{GridOptics{.leaf = {0.f, 0.f}, .wood_reflectance = 0.f}}},
                          .direct = std::vector<float>(medium.cells.area.size() * 2),
                          .entering = field.evenSky({&even, 1}, {&even, 1}, {})};
    const GridSolution solution = field.solve(light);
    const GridBalance& balance = solution.balance[0];
    return (balance.absorbed_leaves + balance.absorbed_wood) * balance.incoming / (2. * double{kPi} * area);
  };
  constexpr float least = 1e-3f;
  double omega = 1., found = escaping(1.f);
  if (found <= escape) return 1.f;
  // What is lost grows with Omega, less and less: the secant from 0 stays on one side.
  double low = 0., of_low = 0.;
  constexpr int steps = 8;
  for (int step = 0; step < steps && std::abs(found - escape) > 1e-3 * escape; ++step) {
    const double next = std::clamp(low + (omega - low) * (escape - of_low) / (found - of_low), double{least}, 1.);
    const double of_next = escaping(static_cast<float>(next));
    if (of_next > escape) {
      omega = next;
      found = of_next;
    } else {
      low = next;
      of_low = of_next;
    }
    if (std::abs(of_next - escape) <= 1e-3 * escape) return static_cast<float>(next);
  }
  return static_cast<float>(omega);
}

}  // namespace

void LargeStandField::makeCells() {
  const Stopwatch watch(costs_[kCells].seconds);
  ++costs_[kCells].made;
  std::vector<double> count(kinds_.size());
  for (const Placement& tree : stand_.trees) ++count[tree.kind];
  Bounds box;
  float smallest = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < stand_.trees.size(); ++i) {
    const Bounds& of_tree = turns_[turn_of_tree_[i]]->box;
    box.include(of_tree.low + stand_.trees[i].position);
    box.include(of_tree.high + stand_.trees[i].position);
  }
  for (std::size_t i = 0; i < kinds_.size(); ++i)
    if (kinds_[i]) {
      const glm::vec3 size = leafBounds(*meshes_[i]).size();
      smallest = std::min(smallest, std::max({size.x, size.y, size.z, 1e-6f}));
    }
  // Larger cells where these would be too many, those in which nothing is as well.
  float side = smallest / static_cast<float>(effort_.cells_along);
  const glm::dvec3 extent =
      stand_.period ? glm::dvec3(glm::dvec2(*stand_.period), double{box.size().z}) : glm::dvec3(box.size());
  for (;; side *= 1.1f) {
    double taken = 0.;
    for (std::size_t i = 0; i < kinds_.size(); ++i)
      if (kinds_[i]) taken += count[i] * static_cast<double>(cellsTaken(kinds_[i]->elements, side));
    const glm::dvec3 cells = glm::ceil(extent / double{side});
    constexpr double empty_per_taken = 32., few = 1e6;
    if (taken <= effort_.most_cells && cells.x * cells.y * cells.z <= std::max(few, empty_per_taken * taken)) break;
  }
  stats_.cell_side = side;
  stats_.clumping.assign(kinds_.size(), 1.f);
  tbb::parallel_for(std::size_t{0}, kinds_.size(), [&](std::size_t i) {
    if (!kinds_[i]) return;
    Kind& kind = *kinds_[i];
    kind.clusters = leafClusters(kind.elements, kClusterShare * side);
    kind.groups = clusterGroups(kind.clusters, kFarGroup);
    kind.group_side.clear();
    for (const std::uint32_t of_cluster : kind.clusters.of_side)
      kind.group_side.push_back(2 * kind.groups.of_cluster[of_cluster / 2] + of_cluster % 2);
    stats_.clumping[i] = clumpingByEscape(turnedClusters(kind.clusters, 0.f), kind.box, side, kind.escape);
  });
  trees_.clear();
  tbb::parallel_for(std::size_t{0}, turns_.size(), [&](std::size_t i) {
    turns_[i]->clusters = turnedClusters(kinds_[turns_[i]->kind]->clusters, turns_[i]->rotation);
  });
  for (std::size_t i = 0; i < stand_.trees.size(); ++i)
    trees_.push_back({&turns_[turn_of_tree_[i]]->clusters, stand_.trees[i].position, stand_.trees[i].kind});
  cells_.reset();
  medium_ = standMedium(trees_, box, side, stand_.period);
  stats_.cells = medium_->cells.grid.cells.size();
  stats_.elements = medium_->cells.area.size();
  cells_.emplace(std::move(medium_->cells), stats_.clumping);
}

void LargeStandField::makeSuns(std::span<const std::size_t> seen) {
  const Stopwatch watch(costs_[kSun].seconds);
  const SweepGrid& grid = cells_->medium().grid;
  const std::size_t suns = lighting_->suns.size();
  lit_ = std::make_unique<Lit>();
  // As fine as elements ask for, and as coarse as pictures together must be.
  double leaf_area = 0., leaves = 0., all = 0.;
  for (const Placement& tree : stand_.trees) {
    const FieldElements& elements = kinds_[tree.kind]->elements;
    const glm::dvec3 size(kinds_[tree.kind]->box.size());
    leaf_area += std::accumulate(elements.area.begin(),
                                 elements.area.begin() + static_cast<std::ptrdiff_t>(elements.leaf_elements), 0.);
    leaves += static_cast<double>(elements.leaf_elements);
    all += size.x * size.y + size.y * size.z + size.x * size.z;
  }
  const double line_area = std::max(leaf_area / leaves / double{effort_.pixels}, all / effort_.most_lines);
  lit_->of_seen.resize(suns);
  for (std::size_t sun = 0; sun < suns; ++sun) {
    ++costs_[kSun].made;
    const SunLines lines = sunLines(lighting_->suns[sun].along, line_area, stand_.period);
    lit_->lines.push_back(lines);
    tbb::parallel_for(std::size_t{0}, turns_.size(), [&](std::size_t i) {
      Turn& turn = *turns_[i];
      turn.pictures.resize(1);
      turn.pictures[0] = treePicture(*meshes_[turn.kind], kinds_[turn.kind]->elements, turn.rotation, lines);
    });
    std::vector<SunlitTree> trees;
    for (std::size_t i = 0; i < stand_.trees.size(); ++i)
      trees.push_back({.picture = &turns_[turn_of_tree_[i]]->pictures[0],
                       .sides = 2 * kinds_[stand_.trees[i].kind]->elements.size(),
                       .position = stand_.trees[i].position});
    auto& of_seen = lit_->of_seen[sun];
    of_seen.resize(trees.size());
    for (const std::size_t tree : seen) of_seen[tree].assign(trees[tree].sides, 0);
    std::vector<std::uint32_t>& of_cells = lit_->of_cells.emplace_back(2 * stats_.elements);
    std::vector<std::uint32_t>& shaded =
        lit_->shaded.emplace_back(static_cast<std::size_t>(grid.size.x) * static_cast<std::size_t>(grid.size.y));
    const auto add = [](std::uint32_t& to, std::uint32_t more) {
      std::atomic_ref(to).fetch_add(more, std::memory_order_relaxed);
    };
    const auto lit = [&](std::size_t tree, std::span<const std::uint32_t> of_sides) {
      const std::vector<std::uint32_t>& of_side = kinds_[stand_.trees[tree].kind]->clusters.of_side;
      std::vector<std::uint32_t> of_clusters(2 * trees_[tree].turned->centre.size());
      const bool is_seen = !of_seen[tree].empty();
      for (std::size_t side = 0; side < of_sides.size(); ++side) {
        if (of_sides[side] == 0) continue;
        of_clusters[of_side[side]] += of_sides[side];
        if (is_seen) add(of_seen[tree][side], of_sides[side]);
      }
      const std::vector<std::uint32_t> sides = elementSides(*medium_, cells_->medium(), trees_[tree]);
      for (std::size_t i = 0; i < of_clusters.size(); ++i)
        if (of_clusters[i] > 0) add(of_cells[sides[i / 2] ^ (i % 2)], of_clusters[i]);
    };
    // Where a pixel's line comes to the ground.
    const glm::dmat3 to_space = glm::inverse(glm::transpose(glm::dmat3(lines.right, lines.up, lines.depth)));
    const glm::dvec3 along(lines.along);
    const auto on_ground = [&](const SunTile& tile) {
      for (int y = 0; y < tile.size.y; ++y)
        for (int x = 0; x < tile.size.x; ++x) {
          if (std::isinf(tile.depth[static_cast<std::size_t>(y) * tile.stride + static_cast<std::size_t>(x)])) continue;
          const glm::dvec2 pixel = glm::dvec2(tile.low + glm::ivec2(x, y)) + 0.5;
          glm::dvec3 point = to_space * glm::dvec3(pixel, 0.);
          point += (double{grid.low.z} - point.z) / along.z * along;
          glm::ivec3 cell(glm::floor((point - glm::dvec3(grid.low)) / glm::dvec3(grid.side)));
          cell.z = 0;
          if (!grid.periodic && (cell.x < 0 || cell.y < 0 || cell.x >= grid.size.x || cell.y >= grid.size.y)) continue;
          add(shaded[cellNumber(grid, cell)], 1);
        }
    };
    const bool ground = lighting_->ground_albedo != glm::vec3(0.f) || stand_.period;
    shineOn(trees, lines, lit, ground ? std::function<void(const SunTile&)>(on_ground) : nullptr);
  }
}

void LargeStandField::solveCells() {
  const Stopwatch watch(costs_[kCellSolution].seconds);
  const CellMedium& medium = cells_->medium();
  const SweepGrid& grid = medium.grid;
  const SphereOrdinates& ordinates = cells_->ordinates();
  const FieldLighting& lighting = *lighting_;
  // Bands in which all is alike are solved once.
  const auto alike = [&](std::size_t a, std::size_t b) {
    const int i = static_cast<int>(a), k = static_cast<int>(b);
    if (lighting.sky || lighting.ground_albedo[i] != lighting.ground_albedo[k]) return false;
    for (const FieldKind& kind : lighting.kinds)
      for (const bool wood : {false, true})
        if (!(opticsOf(kind, wood, a) == opticsOf(kind, wood, b))) return false;
    return std::ranges::all_of(lighting.suns,
                               [&](const FieldSun& sun) { return sun.irradiance[i] == sun.irradiance[k]; });
  };
  for (std::size_t band = 0; band < kBands; ++band) {
    const auto same = std::ranges::find_if(lit_->bands, [&](std::size_t other) { return alike(band, other); });
    lit_->as[band] = static_cast<std::size_t>(same - lit_->bands.begin());
    if (same == lit_->bands.end()) lit_->bands.push_back(band);
  }
  std::vector<glm::vec3> sky(ordinates.size(), glm::vec3(0.f));
  glm::dvec3 sky_irradiance(0.);
  if (lighting.sky) {
    sky_irradiance = lighting.sky->irradiance();
    std::vector<Direction> to_sky;
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < ordinates.size(); ++i)
      if (ordinates.weight(i) > 0.f) {
        to_sky.push_back(-ordinates.direction(i));
        places.push_back(i);
      }
    const std::vector<glm::vec3> shares = skyShares(*lighting.sky, to_sky);
    for (std::size_t i = 0; i < places.size(); ++i) sky[places[i]] = shares[i];
  }
  stats_.cell_iterations = 0;
  stats_.cell_error = 0.;
  result_.balance = {};
  for (const std::size_t band : lit_->bands) {
    const int b = static_cast<int>(band);
    ++costs_[kCellSolution].made;
    GridLight light{.optics = {{}}, .direct = std::vector<float>(2 * medium.area.size()), .entering = {}};
    for (const FieldKind& kind : lighting.kinds)
      light.optics[0].push_back({.leaf = kind.leaf[band], .wood_reflectance = kind.wood_reflectance[b]});
    for (GridOptics& optics : light.optics[0]) optics.leaf.gloss = 0.f;
    const float albedo = lighting.ground_albedo[b];
    const bool ground = stand_.period || albedo > 0.f;
    double open = sky_irradiance[b];
    for (const FieldSun& sun : lighting.suns) open -= double{sun.irradiance[b]} * double{sun.along.z};
    light.entering.radiance.resize(ordinates.size());
    for (std::size_t i = 0; i < ordinates.size(); ++i)
      light.entering.radiance[i] =
          ordinates.direction(i).z < 0.f ? sky[i][b] : static_cast<float>(double{albedo} * open) / kPi;
    if (ground) {
      light.entering.ground_albedo = {albedo};
      light.entering.ground_irradiance.resize(lit_->shaded.empty() ? 0 : lit_->shaded[0].size());
    }
    for (std::size_t sun = 0; sun < lighting.suns.size(); ++sun) {
      const double irradiance = lighting.suns[sun].irradiance[b], line = lit_->lines[sun].line_area,
                   level = -double{lighting.suns[sun].along.z}, column = double{grid.side.x} * double{grid.side.y};
      for (std::size_t side = 0; side < light.direct.size(); ++side) {
        const bool wood = medium.material[side / 2] % 2 == 1;
        light.direct[side] += static_cast<float>(irradiance * line * lit_->of_cells[sun][side] /
                                                 ((wood ? 2. : 1.) * double{medium.area[side / 2]}));
      }
      for (std::size_t i = 0; i < light.entering.ground_irradiance.size(); ++i)
        light.entering.ground_irradiance[i] +=
            static_cast<float>(irradiance * std::max(0., level - line * lit_->shaded[sun][i] / column));
    }
    GridSolution solution = cells_->solve(light, effort_.cells);
    if (!solution.told.empty()) result_.converged = false;
    stats_.cell_iterations = std::max(stats_.cell_iterations, solution.iterations);
    stats_.cell_error = std::max(stats_.cell_error, solution.error_bound);
    std::vector<float>& scattered = lit_->scattered.emplace_back(light.direct.size());
    for (std::size_t i = 0; i < medium.area.size(); ++i) {
      const float front = solution.irradiance[2 * i], back = solution.irradiance[2 * i + 1];
      if (medium.material[i] % 2 == 1) {  // of its whole surface
        scattered[2 * i] = scattered[2 * i + 1] =
            std::max(0.f, front - (light.direct[2 * i] + light.direct[2 * i + 1]));
        continue;
      }
      scattered[2 * i] = std::max(0.f, front - light.direct[2 * i]);
      scattered[2 * i + 1] = std::max(0.f, back - light.direct[2 * i + 1]);
    }
    lit_->solutions.push_back(std::move(solution));
  }
  for (std::size_t band = 0; band < kBands; ++band) {
    const GridBalance& found = lit_->solutions[lit_->as[band]].balance[0];
    const double in = found.incoming;
    result_.balance[band] = {.in = in,
                             .absorbed_leaves = in * found.absorbed_leaves,
                             .absorbed_wood = in * found.absorbed_wood,
                             .absorbed_ground = in * found.absorbed_ground,
                             .out_up = in * found.upward,
                             .out_down = in * found.elsewhere};
  }
}

void LargeStandField::solveTrees(std::span<const std::size_t> seen) {
  const CellMedium& medium = cells_->medium();
  const SweepGrid& grid = medium.grid;
  const FieldLighting& lighting = *lighting_;
  const std::size_t bands = lit_->bands.size(), slots = grid.cells.size();
  std::vector<float> optics_same(2 * kinds_.size() * bands), optics_other(optics_same.size());
  for (std::size_t kind = 0; kind < kinds_.size(); ++kind)
    for (std::size_t wood = 0; wood < 2; ++wood)
      for (std::size_t b = 0; b < bands; ++b) {
        const ElementOptics optics = opticsOf(lighting.kinds[kind], wood == 1, lit_->bands[b]);
        // Of wood either side tells of its whole surface.
        optics_same[(2 * kind + wood) * bands + b] = optics.reflectance / kPi;
        optics_other[(2 * kind + wood) * bands + b] = optics.transmittance / kPi;
      }
  // Radiance that the sides of the cells' elements send.
  std::vector<float> sent(2 * medium.area.size() * bands);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, medium.area.size(), 1024), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i)
      for (std::size_t b = 0; b < bands; ++b) {
        const std::vector<float>& irradiance = lit_->solutions[b].irradiance;
        const bool wood = medium.material[i] % 2 == 1;
        const float front = irradiance[2 * i], back = wood ? front : irradiance[2 * i + 1];
        const float same = optics_same[medium.material[i] * bands + b],
                    other = optics_other[medium.material[i] * bands + b];
        sent[2 * i * bands + b] = same * front + other * back;
        sent[(2 * i + 1) * bands + b] = same * back + other * front;
      }
  });
  std::vector<float> ground, open(bands);
  if (lighting.ground_albedo != glm::vec3(0.f)) {
    const std::size_t columns = static_cast<std::size_t>(grid.size.x) * static_cast<std::size_t>(grid.size.y);
    ground.resize(columns * bands);
    for (std::size_t b = 0; b < bands; ++b) {
      const int band = static_cast<int>(lit_->bands[b]);
      double above = lighting.sky ? lighting.sky->irradiance()[band] : 0.;
      for (const FieldSun& sun : lighting.suns) above -= double{sun.irradiance[band]} * double{sun.along.z};
      open[b] = static_cast<float>(double{lighting.ground_albedo[band]} * above) / kPi;
      for (std::size_t i = 0; i < columns; ++i)
        ground[i * bands + b] = lighting.ground_albedo[band] * lit_->solutions[b].ground_irradiance[i] / kPi;
    }
  }

  // Directions are those of the exchange, which all kinds share.
  const auto some = std::ranges::find_if(kinds_, [](const auto& kind) { return kind != nullptr; });
  const std::vector<Direction>& directions = (*some)->exchange.directions;
  std::vector<glm::vec3> sky(directions.size(), glm::vec3(0.f));
  if (lighting.sky) {
    std::vector<Direction> to_sky;
    for (const Direction& along : directions) to_sky.push_back(-along);
    sky = skyShares(*lighting.sky, to_sky);
  }

  double of_tree = 1.;
  for (const auto& kind : kinds_)
    if (kind) of_tree = std::max(of_tree, 8. * static_cast<double>(kind->elements.size() * bands));
  const auto chunk = std::max<std::size_t>(16, static_cast<std::size_t>(kLightMemory / of_tree));
  for (std::size_t begin = 0; begin < seen.size(); begin += chunk) {
    const std::span<const std::size_t> now = seen.subspan(begin, std::min(chunk, seen.size() - begin));
    std::vector<std::vector<float>> around(now.size());
    {
      const Stopwatch watch(costs_[kWalls].seconds);
      std::vector<LitTree> trees(now.size());
      std::vector<std::vector<glm::vec3>> centres(turns_.size());
      for (const std::size_t tree : now) {
        const Turn& turn = *turns_[turn_of_tree_[tree]];
        std::vector<glm::vec3>& of_turn = centres[turn_of_tree_[tree]];
        if (of_turn.empty())
          for (const glm::vec3& centre : kinds_[turn.kind]->elements.centre)
            of_turn.push_back(turned(centre, turn.rotation));
      }
      tbb::parallel_for(std::size_t{0}, now.size(), [&](std::size_t i) {
        LitTree& tree = trees[i];
        const Turn& turn = *turns_[turn_of_tree_[now[i]]];
        tree.position = stand_.trees[now[i]].position;
        tree.low = cellAt(grid, tree.position + turn.box.low);
        tree.size = cellAt(grid, tree.position + turn.box.high) - tree.low + 1;
        tree.own.assign(static_cast<std::size_t>(tree.size.x) * static_cast<std::size_t>(tree.size.y) *
                            static_cast<std::size_t>(tree.size.z),
                        0.f);
        for (std::size_t c = 0; c < turn.clusters.centre.size(); ++c) {
          const glm::ivec3 cell = cellAt(grid, tree.position + turn.clusters.centre[c]);
          const glm::ivec3 in_tree = cell - tree.low;
          const std::uint32_t slot = grid.slot[cellNumber(grid, cell)];
          float all = 0.f;
          for (std::uint32_t e = medium.first_piece[slot]; e < medium.first_piece[slot + 1]; ++e) all += medium.area[e];
          tree.own[static_cast<std::size_t>((in_tree.z * tree.size.y + in_tree.y) * tree.size.x + in_tree.x)] +=
              turn.clusters.clusters->area[c] / all;
        }
        for (float& share : tree.own) share = std::min(share, 1.f);
        around[i].assign(kinds_[turn.kind]->elements.size() * 2 * bands, 0.f);
      });
      const float pixel = kWallPixel * std::min({grid.side.x, grid.side.y, grid.side.z});
      CellsAlong along{.extinction = std::vector<float>(slots), .radiance = std::vector<float>(slots * bands)};
      for (std::uint32_t number = 0; number < directions.size(); ++number) {
        const Direction& s = directions[number];
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, slots, 256), [&](const auto& range) {
          for (std::size_t slot = range.begin(); slot < range.end(); ++slot) {
            float area = 0.f, clumped = 0.f, all = 0.f;
            std::array<float, kBands> sum{};
            for (std::uint32_t e = medium.first_piece[slot]; e < medium.first_piece[slot + 1]; ++e) {
              const float cosine = glm::dot(medium.normal[e], s), seen_area = medium.area[e] * std::abs(cosine);
              area += seen_area;
              all += medium.area[e];
              clumped += medium.area[e] * stats_.clumping[medium.material[e] / 2];
              const float* const from = sent.data() + (2 * std::size_t{e} + (cosine > 0.f ? 0 : 1)) * bands;
              for (std::size_t b = 0; b < bands; ++b) sum[b] += seen_area * from[b];
            }
            along.extinction[slot] = clumped / all * area / grid.volume();
            for (std::size_t b = 0; b < bands; ++b) along.radiance[slot * bands + b] = area > 0.f ? sum[b] / area : 0.f;
          }
        });
        std::array<float, kBands> of_sky{};
        for (std::size_t b = 0; b < bands; ++b) of_sky[b] = sky[number][static_cast<int>(lit_->bands[b])];
        const AroundCells outside{.sky = std::span(of_sky).first(bands),
                                  .ground = ground,
                                  .open = ground.empty() ? std::span<const float>() : std::span<const float>(open)};
        // Of turned trees none or some of the directions are nearest to this one.
        struct Walls {
          std::size_t turn;
          std::span<const std::uint32_t> sides;
          std::size_t direction;
          WallPixels pixels;
        };
        std::vector<Walls> walls;
        std::vector<std::size_t> first_wall;
        for (std::size_t t = 0; t < turns_.size(); ++t) {
          first_wall.push_back(walls.size());
          const OutsideLines& lines = kinds_[turns_[t]->kind]->outside;
          for (std::size_t k = 0; k < directions.size() && !centres[t].empty(); ++k)
            if (turns_[t]->nearest[k] == number)
              walls.push_back(
                  {t, std::span(lines.side).subspan(lines.first[k], lines.first[k + 1] - lines.first[k]), k, {}});
        }
        first_wall.push_back(walls.size());
        tbb::parallel_for(std::size_t{0}, walls.size(), [&](std::size_t i) {
          Walls& wall = walls[i];
          wall.pixels = wallPixels(centres[wall.turn], wall.sides,
                                   turned(directions[wall.direction], turns_[wall.turn]->rotation), pixel);
        });
        tbb::parallel_for(std::size_t{0}, now.size(), [&](std::size_t i) {
          const std::size_t turn = turn_of_tree_[now[i]];
          for (std::size_t w = first_wall[turn]; w < first_wall[turn + 1]; ++w)
            addWallLight(trees[i], grid, along, outside, walls[w].pixels, walls[w].sides,
                         kinds_[turns_[turn]->kind]->per_line, bands, around[i]);
        });
      }
      costs_[kWalls].made += now.size();
    }

    const Stopwatch watch(costs_[kTrees].seconds);
    costs_[kTrees].made += now.size();
    // Trees of a kind side by side.
    std::vector<std::size_t> order(now.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return stand_.trees[now[i]].kind; });
    struct Batch {
      std::size_t begin, end;
    };
    std::vector<Batch> batches;
    for (std::size_t i = 0; i < order.size(); ++i) {
      const auto kind = [&](std::size_t k) { return stand_.trees[now[order[k]]].kind; };
      if (batches.empty() || i - batches.back().begin >= kTogether || kind(i) != kind(batches.back().begin))
        batches.push_back({i, i});
      batches.back().end = i + 1;
    }
    std::vector<std::vector<std::vector<ElementOptics>>> optics(kinds_.size());
    std::vector<double> stays(kinds_.size());
    for (std::size_t kind = 0; kind < kinds_.size(); ++kind) {
      if (!kinds_[kind]) continue;
      std::vector<FieldProblem> all;
      for (const std::size_t band : lit_->bands)
        optics[kind].push_back(
            {opticsOf(lighting.kinds[kind], false, band), opticsOf(lighting.kinds[kind], true, band)});
      for (const auto& of_band : optics[kind]) all.push_back({.optics = of_band});
      stays[kind] = recollision(kinds_[kind]->geometry(), largestAlbedo(all));
    }
    std::vector<FieldResult> of_batches(batches.size());
    tbb::parallel_for(std::size_t{0}, batches.size(), [&](std::size_t batch) {
      const auto [first, last] = batches[batch];
      const std::uint32_t number = stand_.trees[now[order[first]]].kind;
      const Kind& kind = *kinds_[number];
      const FieldElements& elements = kind.elements;
      const std::size_t sides = 2 * elements.size();
      std::vector<DirectLight> direct;           // of each tree and band
      std::vector<std::vector<float>> arriving;  // and what comes from other trees, sky and ground
      for (std::size_t i = first; i < last; ++i)
        for (std::size_t b = 0; b < bands; ++b) {
          const int band = static_cast<int>(lit_->bands[b]);
          DirectLight& of_suns = direct.emplace_back(DirectLight{.irradiance = std::vector<float>(sides)});
          std::vector<float>& around_tree = arriving.emplace_back(sides);
          for (std::size_t side = 0; side < sides; ++side) {
            for (std::size_t sun = 0; sun < lighting.suns.size(); ++sun)
              of_suns.irradiance[side] +=
                  lighting.suns[sun].irradiance[band] * static_cast<float>(lit_->lines[sun].line_area) *
                  static_cast<float>(lit_->of_seen[sun][now[order[i]]][side]) / elements.area[side / 2];
            of_suns.power += double{of_suns.irradiance[side]} * double{elements.area[side / 2]};
            around_tree[side] = around[order[i]][side * bands + b];
          }
        }
      std::vector<FieldProblem> problems;
      for (std::size_t p = 0; p < direct.size(); ++p)
        problems.push_back({.direct = &direct[p], .arriving = arriving[p], .optics = optics[number][p % bands]});
      const std::vector<FieldSolution> solutions = tbb::this_task_arena::isolate(
          [&] { return solveField(kind.geometry(), problems, stays[number], effort_.solver); });
      FieldResult& of_batch = of_batches[batch];
      for (const FieldSolution& solution : solutions) {
        of_batch.iterations = std::max(of_batch.iterations, solution.iterations);
        of_batch.error_bound = std::max(of_batch.error_bound, solution.error_bound);
        of_batch.converged = of_batch.converged && solution.converged;
      }
      const std::uint32_t leaf_count = meshes_[number]->leaf_count;
      std::vector<float> areas(leaf_count);
      for (std::size_t e = 0; e < elements.leaf_elements; ++e) areas[elements.leaf[e]] += elements.area[e];
      for (std::size_t i = first; i < last; ++i) {
        std::vector<LeafLight> leaves(leaf_count, LeafLight{});
        for (std::size_t e = 0; e < elements.leaf_elements; ++e) {
          LeafLight& leaf = leaves[elements.leaf[e]];
          const float share = elements.area[e] / areas[elements.leaf[e]];
          for (std::size_t band = 0; band < kBands; ++band) {
            const std::size_t b = lit_->as[band], p = (i - first) * bands + b;
            const std::vector<float>& scattered = solutions[p].scattered;
            leaf.direct[band].front += share * direct[p].irradiance[2 * e];
            leaf.direct[band].back += share * direct[p].irradiance[2 * e + 1];
            leaf.scattered[band].front += share * scattered[2 * e];
            leaf.scattered[band].back += share * scattered[2 * e + 1];
          }
        }
        result_.trees[now[order[i]]] = std::move(leaves);
      }
    });
    for (const FieldResult& of_batch : of_batches) {
      result_.iterations = std::max(result_.iterations, of_batch.iterations);
      result_.error_bound = std::max(result_.error_bound, of_batch.error_bound);
      result_.converged = result_.converged && of_batch.converged;
    }
  }
}

// What comes to the groups of a far tree's leaves is the mean of what comes to their clusters' elements in the cells.
void LargeStandField::tellFar(std::span<const std::size_t> far) {
  const CellMedium& medium = cells_->medium();
  far_sides_.assign(stand_.trees.size(), {});
  tbb::parallel_for(std::size_t{0}, far.size(), [&](std::size_t i) {
    const ClusteredTree& tree = trees_[far[i]];
    const Kind& kind = *kinds_[tree.kind];
    const std::vector<std::uint32_t> of_clusters = elementSides(*medium_, medium, tree);
    std::vector<glm::vec3> sums(2 * kind.groups.count, glm::vec3(0.f));
    std::vector<float> areas(kind.groups.count);
    for (std::size_t c = 0; c < of_clusters.size(); ++c) {
      const std::uint32_t group = kind.groups.of_cluster[c];
      const float area = kind.clusters.area[c];
      areas[group] += area;
      for (std::uint32_t side = 0; side < 2; ++side)
        for (std::size_t band = 0; band < kBands; ++band) {
          const std::vector<float>& scattered = lit_->scattered[lit_->as[band]];
          sums[2 * group + side][static_cast<int>(band)] += area * scattered[of_clusters[c] ^ side];
        }
    }
    for (std::size_t side = 0; side < sums.size(); ++side) sums[side] /= areas[side / 2];
    far_sides_[far[i]] = std::move(sums);
  });
}

std::span<const std::uint32_t> LargeStandField::farSidesOf(std::uint32_t kind) const {
  return kinds_[kind] ? std::span<const std::uint32_t>(kinds_[kind]->group_side) : std::span<const std::uint32_t>();
}

const FieldElements& LargeStandField::elements(std::uint32_t kind) const {
  return kinds_[kind]->elements;
}

void LargeStandField::requireMemory(const FieldLighting& lighting, std::span<const std::size_t> seen,
                                    std::span<const std::size_t> far) {
  const auto bands = static_cast<double>(kBands), suns = static_cast<double>(lighting.suns.size());
  double bytes = 0., light = 0.;
  for (const std::size_t tree : seen) {
    const std::uint32_t kind = stand_.trees[tree].kind;
    const bool known = kind < kinds_.size() && kinds_[kind];
    const double sides =
        2. * static_cast<double>(known ? kinds_[kind]->elements.size() : std::size_t{meshes_[kind]->leaf_count});
    bytes += sizeof(LeafLight) * static_cast<double>(meshes_[kind]->leaf_count) + 4. * sides * suns;
    light += 4. * bands * sides;
  }
  bytes += std::min(light, kLightMemory);
  if (cells_) {
    bytes += cells_->memoryBytes(1);
    for (const std::size_t tree : far)
      bytes += 2. * sizeof(glm::vec3) * static_cast<double>(kinds_[stand_.trees[tree].kind]->groups.count);
    for (const auto& kind : kinds_)
      if (kind) bytes += static_cast<double>(kind->exchange.memoryBytes() + 4 * kind->outside.side.size());
  }
  stats_.memory = bytes;
  const double most = std::min(effort_.most_memory, availableMemory());
  require(bytes <= most, fmt::format("light field of {} trees in view: memory [MB]", seen.size() + far.size()),
          std::ceil(1e-6 * bytes), fmt::format("at most {:.0f}: fewer trees in view", 1e-6 * most));
}

const FieldResult& LargeStandField::solve(const FieldLighting& lighting, std::span<const std::size_t> seen,
                                          std::span<const std::size_t> far) {
  require(!meshes_.empty(), "number of trees", 0, "at least 1: setStand first");
  requireFieldLighting(lighting, meshes_.size());
  if (cells_stale_) {
    cells_.reset();
    requireMemory(lighting, seen, far);  // as far as it is known before there are elements
    makeKinds();
    makeCells();
    cells_stale_ = false;
    lighting_.reset();
  }
  const bool same_light = lighting_ && lighting_->suns == lighting.suns && lighting_->sky == lighting.sky &&
                          lighting_->kinds == lighting.kinds && lighting_->ground_albedo == lighting.ground_albedo;
  if (same_light && std::ranges::equal(seen, seen_) && std::ranges::equal(far, far_)) return result_;
  lighting_ = lighting;
  seen_.assign(seen.begin(), seen.end());
  far_.assign(far.begin(), far.end());
  try {
    requireMemory(lighting, seen, far);
    result_ = {};
    result_.trees.resize(stand_.trees.size());
    makeSuns(seen);
    solveCells();
    solveTrees(seen);
    tellFar(far);
  } catch (...) {
    lighting_.reset();
    throw;
  }
  return result_;
}

}  // namespace sunfleck
