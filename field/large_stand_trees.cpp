// The trees of a large stand that are solved leaf by leaf.
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>

#include "field/detail/large_stand_state.hpp"
#include "field/field_solver.hpp"
#include "field/sunlit_ends.hpp"
#include "sky/sky_shares.hpp"

namespace sunfleck {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr std::size_t kTogether = 4;  // trees of a kind that are solved side by side
constexpr float kWallPixel = 0.5f;    // of the pictures of light at a tree's walls, in sides of cells [1]
// How much of the work on a tree is on light at its walls and on direct light [1].
constexpr double kOfWalls = 0.5, kOfDirect = 0.1;

}  // namespace

// Radiances that trees are lit by.
struct LargeStandField::Sent {
  std::vector<float> of_elements;  // of each side of the cells' elements and band that differs [1/sr]
  std::vector<float> ground;       // of each column of cells and band; empty: none
  std::vector<float> open;         // of the ground beyond them, of each band; empty: none
  std::vector<glm::vec3> sky;      // in which light travels in each of the exchange's directions
};

LargeStandField::Sent LargeStandField::sent() const {
  const CellMedium& medium = cells_->medium();
  const SweepGrid& grid = medium.grid;
  const FieldLighting& lighting = *lighting_;
  const std::size_t bands = lit_->bands.size();
  Sent all;
  std::vector<float> optics_same(2 * kinds_.size() * bands), optics_other(optics_same.size());
  for (std::size_t kind = 0; kind < kinds_.size(); ++kind)
    for (std::size_t wood = 0; wood < 2; ++wood)
      for (std::size_t b = 0; b < bands; ++b) {
        const ElementOptics optics = detail::opticsOf(lighting.kinds[kind], wood == 1, lit_->bands[b]);
        // Of wood either side tells of its whole surface.
        optics_same[(2 * kind + wood) * bands + b] = optics.reflectance / kPi;
        optics_other[(2 * kind + wood) * bands + b] = optics.transmittance / kPi;
      }
  // Radiance that the sides of the cells' elements send.
  std::vector<float>& sent = all.of_elements;
  sent.resize(2 * medium.area.size() * bands);
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
  if (lighting.ground_albedo != glm::vec3(0.f)) {
    const std::size_t columns = static_cast<std::size_t>(grid.size.x) * static_cast<std::size_t>(grid.size.y);
    all.ground.resize(columns * bands);
    all.open.resize(bands);
    for (std::size_t b = 0; b < bands; ++b) {
      const int band = static_cast<int>(lit_->bands[b]);
      double above = lighting.sky ? lighting.sky->irradiance()[band] : 0.;
      for (const FieldSun& sun : lighting.suns) above -= double{sun.irradiance[band]} * double{sun.along.z};
      all.open[b] = static_cast<float>(double{lighting.ground_albedo[band]} * above) / kPi;
      for (std::size_t i = 0; i < columns; ++i)
        all.ground[i * bands + b] = lighting.ground_albedo[band] * lit_->solutions[b].ground_irradiance[i] / kPi;
    }
  }

  const std::vector<Direction>& directions = exchangeDirections();
  all.sky.assign(directions.size(), glm::vec3(0.f));
  if (lighting.sky) {
    std::vector<Direction> to_sky;
    for (const Direction& along : directions) to_sky.push_back(-along);
    all.sky = skyShares(*lighting.sky, to_sky);
  }
  return all;
}

// All kinds share them.
const std::vector<Direction>& LargeStandField::exchangeDirections() const {
  return (*std::ranges::find_if(kinds_, [](const auto& kind) { return kind != nullptr; }))->exchange.directions;
}

CellsAlong LargeStandField::cellsAlong(const Direction& s, std::span<const float> sent) const {
  const CellMedium& medium = cells_->medium();
  const SweepGrid& grid = medium.grid;
  const std::size_t bands = lit_->bands.size(), slots = grid.cells.size();
  CellsAlong along{.extinction = std::vector<float>(slots), .radiance = std::vector<float>(slots * bands)};
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
  return along;
}

LitTree LargeStandField::litTree(std::size_t number) const {
  const CellMedium& medium = cells_->medium();
  const SweepGrid& grid = medium.grid;
  const Turn& turn = *turns_[turn_of_tree_[number]];
  LitTree tree;
  tree.position = stand_.trees[number].position;
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
  return tree;
}

// (F29) Irradiance of each side of each tree's elements and band by what comes from outside.
std::vector<std::vector<float>> LargeStandField::lightAtWalls(std::span<const std::size_t> now, const Sent& sent,
                                                              SharedProgress& progress) {
  const SweepGrid& grid = cells_->medium().grid;
  const std::size_t bands = lit_->bands.size();
  const std::vector<Direction>& directions = exchangeDirections();
  std::vector<std::vector<float>> around(now.size());
  const Stopwatch watch(costs_[detail::kWalls].seconds);
  std::vector<LitTree> trees(now.size());
  std::vector<std::vector<glm::vec3>> centres(turns_.size());
  for (const std::size_t tree : now) {
    const Turn& turn = *turns_[turn_of_tree_[tree]];
    std::vector<glm::vec3>& of_turn = centres[turn_of_tree_[tree]];
    if (of_turn.empty())
      for (const glm::vec3& centre : kinds_[turn.kind]->elements.centre)
        of_turn.push_back(detail::turnedBy(centre, turn.rotation));
  }
  tbb::parallel_for(std::size_t{0}, now.size(), [&](std::size_t i) {
    trees[i] = litTree(now[i]);
    around[i].assign(kinds_[stand_.trees[now[i]].kind]->elements.size() * 2 * bands, 0.f);
    progress.ask();
  });
  const float pixel = kWallPixel * std::min({grid.side.x, grid.side.y, grid.side.z});
  for (std::uint32_t number = 0; number < directions.size(); ++number) {
    progress.ask();
    const CellsAlong along = cellsAlong(directions[number], sent.of_elements);
    std::array<float, kBands> of_sky{};
    for (std::size_t b = 0; b < bands; ++b) of_sky[b] = sent.sky[number][static_cast<int>(lit_->bands[b])];
    const AroundCells outside{.sky = std::span(of_sky).first(bands), .ground = sent.ground, .open = sent.open};
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
                               detail::turnedBy(directions[wall.direction], turns_[wall.turn]->rotation), pixel);
    });
    tbb::parallel_for(std::size_t{0}, now.size(), [&](std::size_t i) {
      const std::size_t turn = turn_of_tree_[now[i]];
      for (std::size_t w = first_wall[turn]; w < first_wall[turn + 1]; ++w)
        addWallLight(trees[i], grid, along, outside, walls[w].pixels, walls[w].sides,
                     kinds_[turns_[turn]->kind]->per_line, bands, around[i]);
      progress.add(kOfWalls / static_cast<double>(directions.size()));
    });
  }
  costs_[detail::kWalls].made += now.size();
  return around;
}

// (F3) Irradiance of each side of a tree's elements by a sun of irradiance 1.
std::vector<float> LargeStandField::directLight(std::size_t tree, std::size_t sun) const {
  const FieldElements& elements = kinds_[stand_.trees[tree].kind]->elements;
  std::vector<float> irradiance(2 * elements.size());
  for (std::size_t side = 0; side < irradiance.size(); ++side)
    irradiance[side] = static_cast<float>(lit_->lines[sun].line_area) *
                       static_cast<float>(lit_->of_seen[sun][tree][side]) / elements.area[side / 2];
  return irradiance;
}

// (F6) Of each tree, band after band, what the lines of its sides bring of direct light, scattered once where it falls.
std::vector<std::vector<float>> LargeStandField::scatteredOnce(std::span<const std::size_t> now,
                                                               SharedProgress& progress) const {
  const FieldLighting& lighting = *lighting_;
  const std::size_t bands = lit_->bands.size();
  std::vector<std::vector<float>> once(now.size());
  // Trees that are turned alike share what their lines see in the sun's picture.
  std::vector<std::vector<std::size_t>> of_turns(turns_.size());
  for (std::size_t i = 0; i < now.size(); ++i) {
    of_turns[turn_of_tree_[now[i]]].push_back(i);
    once[i].resize(2 * kinds_[stand_.trees[now[i]].kind]->elements.size() * bands);
  }
  std::erase_if(of_turns, [](const auto& of_turn) { return of_turn.empty(); });
  for (std::size_t sun = lighting.suns.size(); sun-- > 0;)
    tbb::parallel_for(std::size_t{0}, of_turns.size(), [&](std::size_t number) {
      Turn& turn = *turns_[turn_of_tree_[now[of_turns[number].front()]]];
      const Kind& kind = *kinds_[turn.kind];
      const SunlitEnds ends = tbb::this_task_arena::isolate([&] {
        return SunlitEnds(kind.elements, kind.exchange, turn.rotation, lit_->lines[sun], pictureOf(turn, sun));
      });
      const auto bringTo = [&](std::size_t k) {
        const std::size_t i = of_turns[number][k];
        const std::vector<glm::vec3> brought = ends.scatteredOnce(directLight(now[i], sun), lit_->pixels[sun][now[i]]);
        for (std::size_t b = 0; b < bands; ++b) {
          const std::size_t band = lit_->bands[b];
          const ElementOptics leaf = detail::opticsOf(lighting.kinds[turn.kind], false, band),
                              wood = detail::opticsOf(lighting.kinds[turn.kind], true, band);
          const glm::vec3 share = lighting.suns[sun].irradiance[static_cast<int>(band)] *
                                  glm::vec3(leaf.reflectance, leaf.transmittance, wood.reflectance);
          float* const of_band = once[i].data() + b * brought.size();
          for (std::size_t side = 0; side < brought.size(); ++side) of_band[side] += glm::dot(share, brought[side]);
        }
        progress.add(kOfDirect / static_cast<double>(lighting.suns.size()));
      };
      // A thread that waits for others would else begin with other turns, and hold their ends as well.
      tbb::this_task_arena::isolate([&] { tbb::parallel_for(std::size_t{0}, of_turns[number].size(), bringTo); });
    });
  return once;
}

void LargeStandField::solveAlongLines(std::span<const std::size_t> now, std::span<const std::vector<float>> around,
                                      SharedProgress& progress) {
  const FieldLighting& lighting = *lighting_;
  const std::size_t bands = lit_->bands.size();
  const Stopwatch watch(costs_[detail::kTrees].seconds);
  costs_[detail::kTrees].made += now.size();
  const std::vector<std::vector<float>> once = scatteredOnce(now, progress);
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
          {detail::opticsOf(lighting.kinds[kind], false, band), detail::opticsOf(lighting.kinds[kind], true, band)});
    for (const auto& of_band : optics[kind]) all.push_back({.optics = of_band});
    stays[kind] = recollision(kinds_[kind]->geometry(), largestAlbedo(all), progress.asking());
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
    for (std::size_t i = first; i < last; ++i) {
      for (std::size_t b = 0; b < bands; ++b) {
        direct.emplace_back(DirectLight{.irradiance = std::vector<float>(sides)});
        arriving.emplace_back(sides);
        for (std::size_t side = 0; side < sides; ++side) arriving.back()[side] = around[order[i]][side * bands + b];
      }
      for (std::size_t sun = 0; sun < lighting.suns.size(); ++sun) {
        const std::vector<float> of_sun = directLight(now[order[i]], sun);
        for (std::size_t b = 0; b < bands; ++b)
          for (std::size_t side = 0; side < sides; ++side)
            direct[(i - first) * bands + b].irradiance[side] +=
                lighting.suns[sun].irradiance[static_cast<int>(lit_->bands[b])] * of_sun[side];
      }
    }
    std::vector<FieldProblem> problems;
    for (std::size_t p = 0; p < direct.size(); ++p) {
      for (std::size_t side = 0; side < sides; ++side)
        direct[p].power += double{direct[p].irradiance[side]} * double{elements.area[side / 2]};
      problems.push_back({.direct = &direct[p],
                          .scattered_once = std::span(once[order[first + p / bands]]).subspan(p % bands * sides, sides),
                          .arriving = arriving[p],
                          .optics = optics[number][p % bands]});
    }
    const std::vector<FieldSolution> solutions = tbb::this_task_arena::isolate(
        [&] { return solveField(kind.geometry(), problems, stays[number], effort_.solver, progress.asking()); });
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
    progress.add(static_cast<double>(last - first) * (1. - kOfWalls - kOfDirect));
  });
  for (const FieldResult& of_batch : of_batches) {
    result_.iterations = std::max(result_.iterations, of_batch.iterations);
    result_.error_bound = std::max(result_.error_bound, of_batch.error_bound);
    result_.converged = result_.converged && of_batch.converged;
  }
}

void LargeStandField::solveTrees(std::span<const std::size_t> seen, const Progress& progress) {
  if (seen.empty()) return;
  SharedProgress trees_done(progress, static_cast<double>(seen.size()));
  const Sent sent = this->sent();
  double of_tree = 1.;
  for (const auto& kind : kinds_)
    if (kind) of_tree = std::max(of_tree, 16. * static_cast<double>(kind->elements.size() * lit_->bands.size()));
  const auto chunk = std::max<std::size_t>(16, static_cast<std::size_t>(detail::kLargeStandLight / of_tree));
  for (std::size_t begin = 0; begin < seen.size(); begin += chunk) {
    const std::span<const std::size_t> now = seen.subspan(begin, std::min(chunk, seen.size() - begin));
    solveAlongLines(now, lightAtWalls(now, sent, trees_done), trees_done);
  }
}

}  // namespace sunfleck
