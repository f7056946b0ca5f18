#include "field/cell_field.hpp"

#include <algorithm>
#include <numbers>
#include <numeric>

#include "core/require.hpp"
#include "field/ground_light.hpp"
#include "sky/sky_shares.hpp"

namespace sunfleck {
namespace {

constexpr std::array<std::size_t, 1> kOnly{0};
constexpr std::size_t kLanes = SphereOrdinates::kLanes;

}  // namespace

CellField::CellField(const CellFieldEffort& effort)
    : effort_(effort),
      clumping_product_(graph_.add("clumping")),
      cells_product_(graph_.add("cells")),
      direct_product_(graph_.add("direct light")),
      solution_product_(graph_.add("solutions")) {
  const auto all = [](std::size_t members) {
    return [members](std::size_t, const ProductGraph::Mark& mark) {
      for (std::size_t member = 0; member < members; ++member) mark(member);
    };
  };
  graph_.follows(cells_product_, clumping_product_, all(1));
  graph_.follows(direct_product_, cells_product_, all(kMostFieldSuns));
  graph_.follows(solution_product_, cells_product_, all(kSources));
  graph_.follows(solution_product_, direct_product_,
                 [](std::size_t sun, const ProductGraph::Mark& mark) { mark(sun); });
  graph_.resize(cells_product_, 1);
  graph_.resize(direct_product_, kMostFieldSuns);
  graph_.resize(solution_product_, kSources);
}

void CellField::setStand(std::span<const std::shared_ptr<const TreeMesh>> kinds, const Stand& stand) {
  requireFieldStand(kinds, stand);
  const bool same_kinds = std::equal(kinds.begin(), kinds.end(), meshes_.begin(), meshes_.end());
  if (same_kinds && stand == stand_) return;
  graph_.resize(clumping_product_, kinds.size());
  for (std::size_t kind = 0; kind < kinds.size(); ++kind)
    if (kind >= meshes_.size() || kinds[kind] != meshes_[kind]) graph_.touch(clumping_product_, kind);
  of_kinds_.resize(kinds.size());
  clumping_.resize(kinds.size(), 1.f);
  meshes_.assign(kinds.begin(), kinds.end());
  stand_ = stand;
  lighting_.kinds.clear();  // what was told of others
  graph_.touch(cells_product_, 0);
}

const FieldResult& CellField::solve(const FieldLighting& lighting, const Progress& progress) {
  require(!meshes_.empty(), "number of trees", 0, "at least 1: setStand first");
  requireFieldLighting(lighting, meshes_.size());
  for (std::size_t sun = 0; sun < lighting.suns.size(); ++sun)
    if (sun >= lighting_.suns.size() || lighting.suns[sun].along != lighting_.suns[sun].along)
      graph_.touch(direct_product_, sun);
  if (lighting.kinds != lighting_.kinds || lighting.ground_albedo != lighting_.ground_albedo)
    graph_.touchAll(solution_product_);
  if (lighting.sky != lighting_.sky) graph_.touch(solution_product_, kSky);
  lighting_ = lighting;

  constexpr double kCells = 0.4, kDirect = 0.6;  // how far it is, by how long parts take
  std::vector<std::size_t> kinds;                // that stand
  for (std::size_t kind = 0; kind < meshes_.size(); ++kind)
    if (std::ranges::find(stand_.trees, kind, &Placement::kind) != stand_.trees.end()) kinds.push_back(kind);
  requireGoOn(progress, 0.);
  graph_.bring(clumping_product_, kinds, [&](std::size_t kind) {
    const TreeMesh& mesh = *meshes_[kind];
    of_kinds_[kind] = fieldElements(mesh, effort_.elements);
    const PlacedElements alone{.mesh = &mesh, .elements = &of_kinds_[kind]};
    clumping_[kind] = clumping(mesh, cellMedium(std::span(&alone, 1), effort_.cells), effort_.clumping);
  });
  requireGoOn(progress, 0.5 * kCells);
  graph_.bring(cells_product_, kOnly, [&](std::size_t) { makeCells(); });
  requireGoOn(progress, kCells);
  std::vector<std::size_t> sources(lighting.suns.size());
  std::iota(sources.begin(), sources.end(), std::size_t{0});
  graph_.bring(direct_product_, sources, [&](std::size_t sun) {
    direct_[sun] =
        directLight(elements_.mesh, elements_.elements, stand_.period, lighting_.suns[sun].along, effort_.direct);
  });
  if (lighting.sky) sources.push_back(kSky);
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const auto from = [&](std::size_t source) {
      return kDirect + (1. - kDirect) * static_cast<double>(source) / static_cast<double>(sources.size());
    };
    requireGoOn(progress, from(i));
    graph_.bring(solution_product_, std::span(sources).subspan(i, 1),
                 [&](std::size_t source) { makeSolution(source, partOf(progress, from(i), from(i + 1))); });
  }
  result_ = fieldResult(elements_, parts());
  return result_;
}

void CellField::makeCells() {
  elements_ = standElements(meshes_, of_kinds_, stand_);
  std::vector<PlacedElements> trees;
  for (const Placement& tree : stand_.trees)
    trees.push_back({.mesh = meshes_[tree.kind].get(), .elements = &of_kinds_[tree.kind], .placement = tree});
  CellMedium medium = cellMedium(trees, effort_.cells, stand_.period);
  in_cells_.clear();
  for (const bool wood : {false, true})
    for (std::size_t tree = 0; tree < stand_.trees.size(); ++tree) {
      const std::size_t first = medium.first_element[tree], leaves = of_kinds_[stand_.trees[tree].kind].leaf_elements;
      for (std::size_t i = first + (wood ? leaves : 0); i < (wood ? medium.first_element[tree + 1] : first + leaves);
           ++i)
        in_cells_.push_back(i);
    }
  cells_.emplace(std::move(medium), clumping_);
  ground_shares_.clear();
}

EnteringLight CellField::entering(std::size_t source, std::span<const std::size_t> bands) const {
  const SphereOrdinates& ordinates = cells_->ordinates();
  const bool periodic = stand_.period.has_value();
  EnteringLight light{.radiance = std::vector<float>(ordinates.size() * bands.size())};
  std::vector<glm::vec3> sky(ordinates.size(), glm::vec3(0.f));
  glm::vec3 ground(0.f);  // radiance of open ground
  if (source == kSky) {
    std::vector<Direction> to_sky;
    for (std::size_t i = 0; i < ordinates.size(); ++i)
      if (ordinates.weight(i) > 0.f) to_sky.push_back(-ordinates.direction(i));
    const std::vector<glm::vec3> shares = skyShares(*lighting_.sky, to_sky);
    for (std::size_t i = 0, next = 0; i < ordinates.size(); ++i)
      if (ordinates.weight(i) > 0.f) sky[i] = shares[next++];
    ground = glm::vec3(lighting_.sky->irradiance());
  } else {
    ground = glm::vec3(-direct_[source].along.z);
  }
  ground *= lighting_.ground_albedo * std::numbers::inv_pi_v<float>;
  for (std::size_t k = 0; k < bands.size(); ++k) {
    const int band = static_cast<int>(bands[k]);
    for (std::size_t i = 0; i < ordinates.size(); ++i)
      light.radiance[(i / kLanes * bands.size() + k) * kLanes + i % kLanes] = ordinates.direction(i).z < 0.f
                                                                                  ? sky[i][band]
                                                                              : periodic ? 0.f
                                                                                         : ground[band];
    if (periodic) light.ground_albedo.push_back(lighting_.ground_albedo[band]);
  }
  if (periodic && source != kSky) {
    const glm::ivec3 size = cells_->medium().grid.size;
    const double area = double{stand_.period->x} * double{stand_.period->y};
    light.ground_irradiance.assign(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * bands.size(),
                                   static_cast<float>(direct_[source].ground_power / area));
  }
  return light;
}

void CellField::makeSolution(std::size_t source, const Progress& progress) {
  std::array<FieldSolution, kBands>& solutions = solutions_[source];
  // Of bands in which all is alike one sun's light is solved once.
  std::vector<std::size_t> bands;
  std::array<std::size_t, kBands> found{};
  for (std::size_t band = 0; band < kBands; ++band) {
    const auto alike = [&](std::size_t other) {
      return source != kSky &&
             lighting_.ground_albedo[static_cast<int>(band)] == lighting_.ground_albedo[static_cast<int>(other)] &&
             std::ranges::all_of(lighting_.kinds, [&](const FieldKind& kind) {
               return kind.leaf[band] == kind.leaf[other] &&
                      kind.wood_reflectance[static_cast<int>(band)] == kind.wood_reflectance[static_cast<int>(other)];
             });
    };
    const auto same = std::ranges::find_if(bands, alike);
    found[band] = static_cast<std::size_t>(same - bands.begin());
    if (same == bands.end()) bands.push_back(band);
  }
  const std::size_t count = bands.size(), elements = in_cells_.size();
  GridLight light{
      .optics = {}, .direct = std::vector<float>(2 * elements * count), .entering = entering(source, bands)};
  for (const std::size_t band : bands) {
    std::vector<GridOptics>& optics = light.optics.emplace_back();
    for (const FieldKind& kind : lighting_.kinds)
      optics.push_back({.leaf = kind.leaf[band], .wood_reflectance = kind.wood_reflectance[static_cast<int>(band)]});
  }
  if (source != kSky)
    for (std::size_t i = 0; i < elements; ++i)
      for (std::size_t side = 0; side < 2; ++side)
        std::fill_n(light.direct.begin() + static_cast<std::ptrdiff_t>((2 * in_cells_[i] + side) * count), count,
                    direct_[source].irradiance[2 * i + side]);
  const GridSolution solution = cells_->solve(light, effort_.solver, progress);
  for (std::size_t band = 0; band < kBands; ++band) {
    FieldSolution& of_band = solutions[band];
    of_band = {.scattered = std::vector<float>(2 * elements),
               .iterations = solution.iterations,
               .error_bound = solution.error_bound,
               .converged = solution.told.empty()};
    const auto at = [&](std::size_t i, std::size_t side) { return (2 * in_cells_[i] + side) * count + found[band]; };
    for (std::size_t i = 0; i < elements_.elements.leaf_elements; ++i)
      for (std::size_t side = 0; side < 2; ++side)
        of_band.scattered[2 * i + side] = std::max(solution.irradiance[at(i, side)] - light.direct[at(i, side)], 0.f);
    // Of wood all is told in front, direct light of both sides too.
    for (std::size_t i = elements_.elements.leaf_elements; i < elements; ++i)
      of_band.scattered[2 * i] =
          std::max(solution.irradiance[at(i, 0)] - light.direct[at(i, 0)] - light.direct[at(i, 1)], 0.f);
    const GridBalance& balance = solution.balance[found[band]];
    of_band.balance = {.in = balance.incoming,
                       .absorbed_leaves = balance.absorbed_leaves * balance.incoming,
                       .absorbed_wood = balance.absorbed_wood * balance.incoming,
                       .absorbed_ground = balance.absorbed_ground * balance.incoming,
                       .out_up = balance.upward * balance.incoming,
                       .out_down = balance.elsewhere * balance.incoming};
  }
}

std::vector<FieldPart> CellField::parts() const {
  std::vector<FieldPart> parts;
  const auto add = [&](std::size_t source, const glm::vec3& scale) {
    FieldPart& part = parts.emplace_back();
    part.scale = scale;
    if (source != kSky) part.direct = &direct_[source];
    for (std::size_t band = 0; band < kBands; ++band) part.solutions[band] = &solutions_[source][band];
  };
  for (std::size_t sun = 0; sun < lighting_.suns.size(); ++sun) add(sun, lighting_.suns[sun].irradiance);
  if (lighting_.sky) add(kSky, glm::vec3(1.f));
  return parts;
}

// (F31)
std::vector<glm::vec3> CellField::groundLight(const GroundGrid& grid) {
  const std::vector<glm::vec3> sent = sentRadiance(elements_, parts(), lighting_.kinds);
  std::vector<glm::vec3> radiance(sent.size());
  for (std::size_t i = 0; i < in_cells_.size(); ++i)
    for (std::size_t side = 0; side < 2; ++side)
      radiance[2 * in_cells_[i] + side] = sent[2 * i + (i < elements_.elements.leaf_elements ? side : 0)];
  if (ground_shares_.empty()) ground_shares_ = groundShares(cells_->medium(), clumping_);
  return sunfleck::groundLight(grid, cells_->medium(), clumping_, ground_shares_, radiance);
}

}  // namespace sunfleck
