// The light of a large stand that is not that of single trees: of its suns, and in its cells.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <utility>

#include "field/detail/large_stand_state.hpp"
#include "sky/sky_shares.hpp"

namespace sunfleck {

using detail::opticsOf;

namespace {

constexpr float kPi = std::numbers::pi_v<float>;

}  // namespace

// As fine as elements ask for, and as coarse as pictures together must be [m^2]. Of kinds that are not made, what their
// meshes tell: then it is no finer than it will be.
double LargeStandField::lineArea() const {
  struct OfKind {
    double trees = 0., leaf_area = 0., leaves = 0., box = 0.;
  };
  std::vector<OfKind> of_kinds(meshes_.size());
  for (const Placement& tree : stand_.trees) ++of_kinds[tree.kind].trees;
  for (std::size_t i = 0; i < of_kinds.size(); ++i) {
    OfKind& of_kind = of_kinds[i];
    if (of_kind.trees == 0.) continue;
    const glm::dvec3 size(boxOf(i).size());
    of_kind.box = size.x * size.y + size.y * size.z + size.x * size.z;
    if (i < kinds_.size() && kinds_[i]) {
      const FieldElements& elements = kinds_[i]->elements;
      of_kind.leaf_area = std::accumulate(
          elements.area.begin(), elements.area.begin() + static_cast<std::ptrdiff_t>(elements.leaf_elements), 0.);
      of_kind.leaves = static_cast<double>(elements.leaf_elements);
    } else {
      of_kind.leaf_area = leafArea(*meshes_[i]);
      of_kind.leaves = static_cast<double>(meshes_[i]->leaf_count);
    }
  }
  double leaf_area = 0., leaves = 0., all = 0.;
  for (const Placement& tree : stand_.trees) {
    leaf_area += of_kinds[tree.kind].leaf_area;
    leaves += of_kinds[tree.kind].leaves;
    all += of_kinds[tree.kind].box;
  }
  return std::max(leaf_area / leaves / double{effort_.pixels}, all / effort_.most_lines);
}

Bounds LargeStandField::boxOf(std::size_t kind) const {
  return kind < kinds_.size() && kinds_[kind] ? kinds_[kind]->box : bounds(*meshes_[kind]);
}

// Pictures are held of one sun at a time. A tree is taken to fill an ellipsoid of its box's size, as crowns about do.
double LargeStandField::pictureBytes(const FieldLighting& lighting) const {
  std::set<std::pair<std::uint32_t, float>> turns;
  for (const Placement& tree : stand_.trees) turns.emplace(tree.kind, tree.rotation);
  std::map<std::uint32_t, glm::vec3> sizes;
  for (const auto& [kind, rotation] : turns)
    if (!sizes.contains(kind)) sizes[kind] = boxOf(kind).size();
  const double line_area = lineArea();
  double most = 0.;
  for (const FieldSun& sun : lighting.suns) {
    const SunLines lines = sunLines(sun.along, line_area, stand_.period);
    double pixels = 0.;
    for (const auto& [kind, rotation] : turns) {
      const glm::vec3 size = sizes[kind];
      glm::dvec2 squares(0.);
      for (int axis = 0; axis < 3; ++axis) {
        glm::vec3 along(0.f);
        along[axis] = size[axis];
        const glm::dvec3 turned(detail::turnedBy(along, rotation));
        const glm::dvec2 seen(glm::dot(lines.right, turned), glm::dot(lines.up, turned));
        squares += seen * seen;
      }
      pixels += std::sqrt(squares.x * squares.y);
    }
    most = std::max(most, pixels);
  }
  return most * detail::kBytesOfPixel;
}

// Of the suns whose lines are known.
const TreePicture& LargeStandField::pictureOf(Turn& turn, std::size_t sun) const {
  if (turn.of_sun != sun) {
    turn.picture = treePicture(*meshes_[turn.kind], kinds_[turn.kind]->elements, turn.rotation, lit_->lines[sun]);
    turn.of_sun = sun;
  }
  return turn.picture;
}

void LargeStandField::makeSuns(std::span<const std::size_t> seen, const Progress& progress) {
  const Stopwatch watch(costs_[detail::kSun].seconds);
  const SweepGrid& grid = cells_->medium().grid;
  const std::size_t suns = lighting_->suns.size();
  lit_ = std::make_unique<Lit>();
  lit_->lines.reserve(suns);
  for (const auto& turn : turns_) turn->of_sun = Turn::kNoSun;
  const double line_area = lineArea();
  lit_->of_seen.resize(suns);
  lit_->pixels.resize(suns);
  for (std::size_t sun = 0; sun < suns; ++sun) {
    ++costs_[detail::kSun].made;
    const SunLines& lines = lit_->lines.emplace_back(sunLines(lighting_->suns[sun].along, line_area, stand_.period));
    const auto part = [&](double of_sun) { return (static_cast<double>(sun) + of_sun) / static_cast<double>(suns); };
    constexpr double kOfPictures = 0.3;  // how far these are
    const Progress of_pictures = partOf(progress, part(0.), part(kOfPictures)),
                   of_tiles = partOf(progress, part(kOfPictures), part(1.));
    SharedProgress pictures_done(of_pictures, static_cast<double>(turns_.size()));
    tbb::parallel_for(std::size_t{0}, turns_.size(), [&](std::size_t i) {
      pictureOf(*turns_[i], sun);
      pictures_done.add();
    });
    std::vector<SunlitTree> trees;
    for (std::size_t i = 0; i < stand_.trees.size(); ++i)
      trees.push_back({.picture = &turns_[turn_of_tree_[i]]->picture,
                       .sides = 2 * kinds_[stand_.trees[i].kind]->elements.size(),
                       .position = stand_.trees[i].position});
    auto& of_seen = lit_->of_seen[sun];
    of_seen.resize(trees.size());
    std::vector<LitPixels>& pixels = lit_->pixels[sun];
    pixels.resize(trees.size());
    for (const std::size_t tree : seen) {
      of_seen[tree].assign(trees[tree].sides, 0);
      pixels[tree] = LitPixels(*trees[tree].picture);
      trees[tree].pixels = &pixels[tree];
    }
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
    shineOn(trees, lines, lit, ground ? std::function<void(const SunTile&)>(on_ground) : nullptr, of_tiles);
  }
}

void LargeStandField::solveCells(const Progress& progress) {
  const Stopwatch watch(costs_[detail::kCellSolution].seconds);
  const CellMedium& medium = cells_->medium();
  const SweepGrid& grid = medium.grid;
  const SphereOrdinates& ordinates = cells_->ordinates();
  const FieldLighting& lighting = *lighting_;
  lit_->bands.clear();
  lit_->solutions.clear();
  lit_->scattered.clear();
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
  result_ = {};
  result_.trees.resize(stand_.trees.size());
  for (const std::size_t band : lit_->bands) {
    const auto part = [&](std::size_t solved) {
      return static_cast<double>(solved) / static_cast<double>(lit_->bands.size());
    };
    const std::size_t solved = lit_->solutions.size();
    requireGoOn(progress, part(solved));
    const int b = static_cast<int>(band);
    ++costs_[detail::kCellSolution].made;
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
    GridSolution solution = cells_->solve(light, effort_.cells, partOf(progress, part(solved), part(solved + 1)));
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

// What comes to the groups of a far tree's leaves is the mean of what comes to their clusters' elements in the cells.
void LargeStandField::tellFar(std::span<const std::size_t> far, SharedProgress& progress) {
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
    progress.add();
  });
}

}  // namespace sunfleck
