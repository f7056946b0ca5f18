#include "field/leaf_field.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>
#include <string>

#include "core/require.hpp"
#include "field/field_input.hpp"
#include "sky/sky_shares.hpp"

namespace sunfleck {
namespace {

constexpr std::array<std::size_t, 1> kOnly{0};

// Its direction by the direction that a tree turns to.
glm::vec3 turned(const glm::vec3& vector, float cosine, float sine) {
  return {cosine * vector.x - sine * vector.y, sine * vector.x + cosine * vector.y, vector.z};
}

void append(std::vector<glm::uvec3>& to, const std::vector<glm::uvec3>& triangles, std::uint32_t first_vertex) {
  for (const glm::uvec3& triangle : triangles) to.push_back(triangle + first_vertex);
}

}  // namespace

LeafField::LeafField(const FieldEffort& effort)
    : effort_(effort),
      elements_product_(graph_.add("elements")),
      exchange_product_(graph_.add("exchange")),
      recollision_product_(graph_.add("recollision")),
      direct_product_(graph_.add("direct light")),
      solution_product_(graph_.add("solutions")) {
  const auto all = [](std::size_t members) {
    return [members](std::size_t, const ProductGraph::Mark& mark) {
      for (std::size_t member = 0; member < members; ++member) mark(member);
    };
  };
  graph_.follows(exchange_product_, elements_product_, all(1));
  graph_.follows(direct_product_, elements_product_, all(kMostSuns));
  graph_.follows(recollision_product_, exchange_product_, all(1));
  graph_.follows(solution_product_, recollision_product_, all(kSources));
  graph_.follows(solution_product_, direct_product_,
                 [](std::size_t sun, const ProductGraph::Mark& mark) { mark(sun); });
  for (const auto product : {elements_product_, exchange_product_, recollision_product_}) graph_.resize(product, 1);
  graph_.resize(direct_product_, kMostSuns);
  graph_.resize(solution_product_, kSources);
}

void LeafField::setStand(std::span<const std::shared_ptr<const TreeMesh>> kinds, const Stand& stand) {
  requireStand(kinds, stand);
  if (stand == stand_ && std::equal(kinds.begin(), kinds.end(), meshes_.begin(), meshes_.end())) return;
  meshes_.assign(kinds.begin(), kinds.end());
  stand_ = stand;
  lighting_.kinds.clear();  // what was told of others
  graph_.touchAll(elements_product_);
}

void LeafField::makeElements() {
  mesh_ = {};
  elements_ = {};
  kinds_.clear();
  first_leaf_.clear();
  // Leaves of all trees come before all wood.
  std::vector<FieldElements> of_kinds(meshes_.size());
  std::vector<char> stands(meshes_.size());
  for (const Placement& tree : stand_.trees) stands[tree.kind] = true;
  tbb::parallel_for(std::size_t{0}, meshes_.size(), [&](std::size_t kind) {
    if (stands[kind]) of_kinds[kind] = fieldElements(*meshes_[kind], effort_.elements);
  });
  const auto take = [&](const Placement& tree, std::size_t begin, std::size_t end, std::uint32_t kind) {
    const FieldElements& elements = of_kinds[tree.kind];
    const float cosine = std::cos(tree.rotation), sine = std::sin(tree.rotation);
    for (std::size_t i = begin; i < end; ++i) {
      elements_.area.push_back(elements.area[i]);
      elements_.centre.push_back(tree.position + turned(elements.centre[i], cosine, sine));
      elements_.normal.push_back(turned(elements.normal[i], cosine, sine));
      const bool wood = elements.leaf[i] == FieldElements::kWood;
      elements_.leaf.push_back(wood ? FieldElements::kWood : mesh_.leaf_count + elements.leaf[i]);
      kinds_.push_back(kind);
    }
  };
  std::vector<std::uint32_t> first_vertex;
  for (const Placement& tree : stand_.trees) {
    const TreeMesh& mesh = *meshes_[tree.kind];
    const FieldElements& elements = of_kinds[tree.kind];
    const float cosine = std::cos(tree.rotation), sine = std::sin(tree.rotation);
    first_vertex.push_back(static_cast<std::uint32_t>(mesh_.vertices.size()));
    for (const glm::vec3& vertex : mesh.vertices)
      mesh_.vertices.push_back(tree.position + turned(vertex, cosine, sine));
    append(mesh_.leaf_triangles, mesh.leaf_triangles, first_vertex.back());
    const auto first = static_cast<std::uint32_t>(elements_.size());
    for (const std::uint32_t element : elements.of_leaf_triangle) elements_.of_leaf_triangle.push_back(first + element);
    take(tree, 0, elements.leaf_elements, 2 * tree.kind);
    for (const std::uint32_t leaf : mesh.leaf_of_triangle) mesh_.leaf_of_triangle.push_back(mesh_.leaf_count + leaf);
    first_leaf_.push_back(mesh_.leaf_count);
    mesh_.leaf_count += mesh.leaf_count;
  }
  first_leaf_.push_back(mesh_.leaf_count);
  elements_.leaf_elements = elements_.size();
  for (std::size_t i = 0; i < stand_.trees.size(); ++i) {
    const Placement& tree = stand_.trees[i];
    const FieldElements& elements = of_kinds[tree.kind];
    append(mesh_.wood_triangles, meshes_[tree.kind]->wood_triangles, first_vertex[i]);
    const std::size_t first = elements_.size() - elements.leaf_elements;  // wraps below 0 and back
    for (const std::uint32_t element : elements.of_wood_triangle)
      elements_.of_wood_triangle.push_back(static_cast<std::uint32_t>(first + element));
    take(tree, elements.leaf_elements, elements.size(), 2 * tree.kind + 1);
  }
}

const FieldResult& LeafField::solve(const FieldLighting& lighting) {
  require(!meshes_.empty(), "number of trees", 0, "at least 1: setStand first");
  requireLighting(lighting, meshes_.size());
  for (std::size_t sun = 0; sun < kMostSuns; ++sun) {
    const bool shines = sun < lighting.suns.size(), shone = sun < lighting_.suns.size();
    if (shines && (!shone || lighting.suns[sun].along != lighting_.suns[sun].along)) graph_.touch(direct_product_, sun);
  }
  if (lighting.kinds != lighting_.kinds || lighting.ground_albedo != lighting_.ground_albedo)
    graph_.touchAll(recollision_product_);
  if (lighting.sky != lighting_.sky) graph_.touch(solution_product_, kSky);
  lighting_ = lighting;

  graph_.bring(elements_product_, kOnly, [&](std::size_t) { makeElements(); });
  graph_.bring(exchange_product_, kOnly, [&](std::size_t) {
    exchange_ = {};  // its memory before that of the next
    exchange_ = lineExchange(mesh_, elements_, stand_.period, effort_.exchange);
  });
  std::vector<std::size_t> suns(lighting.suns.size());
  std::iota(suns.begin(), suns.end(), std::size_t{0});
  graph_.bring(direct_product_, suns, [&](std::size_t sun) {
    direct_[sun] = directLight(mesh_, elements_, stand_.period, lighting_.suns[sun].along, effort_.direct);
  });
  std::vector<std::size_t> sources = suns, stale;
  if (lighting.sky) sources.push_back(kSky);
  for (const std::size_t source : sources)
    if (graph_.stale(solution_product_, source)) stale.push_back(source);
  if (!stale.empty()) makeSolutions(stale);
  graph_.bring(solution_product_, sources, [](std::size_t) {});
  compose();
  return result_;
}

void LeafField::makeSolutions(std::span<const std::size_t> stale) {
  const Stopwatch watch(graph_.cost(solution_product_).seconds);
  const bool periodic = stand_.period.has_value();
  std::array<std::vector<ElementOptics>, kBands> optics;
  for (std::size_t band = 0; band < kBands; ++band)
    for (const FieldKind& kind : lighting_.kinds) {
      optics[band].push_back({kind.leaf[band].reflectance, kind.leaf[band].transmittance});
      optics[band].push_back({kind.wood_reflectance[static_cast<int>(band)], 0.f});
    }
  const auto alike = [&](std::size_t band, std::size_t other) {
    return lighting_.ground_albedo[static_cast<int>(band)] == lighting_.ground_albedo[static_cast<int>(other)] &&
           std::equal(optics[band].begin(), optics[band].end(), optics[other].begin(),
                      [](const ElementOptics& a, const ElementOptics& b) {
                        return a.reflectance == b.reflectance && a.transmittance == b.transmittance;
                      });
  };
  std::array<std::vector<float>, kBands> outside;
  glm::dvec3 sky_irradiance(0.);
  if (lighting_.sky) {
    sky_irradiance = lighting_.sky->irradiance();
    std::vector<Direction> to_sky;
    for (const Direction& along : exchange_.directions) to_sky.push_back(-along);
    for (const glm::vec3& radiance : skyShares(*lighting_.sky, to_sky))
      for (std::size_t band = 0; band < kBands; ++band) outside[band].push_back(radiance[static_cast<int>(band)]);
  }
  struct Asked {
    std::size_t source, band;
  };
  std::vector<FieldProblem> problems;
  std::vector<Asked> asked;
  for (const std::size_t source : stale)
    for (std::size_t band = 0; band < kBands; ++band) {
      // Of bands in which all is alike one sun's light is solved once.
      bool known = false;
      for (std::size_t other = 0; other < band && source != kSky; ++other) known = known || alike(band, other);
      if (known) continue;
      const float albedo = lighting_.ground_albedo[static_cast<int>(band)];
      FieldProblem problem{.direct = {}, .optics = optics[band], .ground_albedo = albedo};
      if (source == kSky) {
        problem.outside = outside[band];
        problem.ground_open = static_cast<float>(sky_irradiance[static_cast<int>(band)]);
      } else {
        problem.direct = direct_[source].irradiance;
        problem.direct_ground = direct_[source].ground_power;
        problem.ground_open = -direct_[source].along.z;
      }
      problems.push_back(problem);
      asked.push_back({source, band});
    }
  // One for all bands, so that it is the same whichever sources are stale.
  std::vector<FieldProblem> all_bands;
  for (std::size_t band = 0; band < kBands; ++band)
    all_bands.push_back(
        {.direct = {}, .optics = optics[band], .ground_albedo = lighting_.ground_albedo[static_cast<int>(band)]});
  graph_.bring(recollision_product_, kOnly, [&](std::size_t) {
    albedo_ = largestAlbedo(all_bands);
    recollision_ = recollision(exchange_, kinds_, albedo_, periodic);
  });
  std::vector<FieldSolution> solutions =
      solveField(elements_, exchange_, kinds_, problems, periodic, recollision_, effort_.solver);
  for (std::size_t i = 0; i < asked.size(); ++i) {
    auto& of_bands = solutions_[asked[i].source];
    for (std::size_t band = asked[i].band + 1; band < kBands && asked[i].source != kSky; ++band)
      if (alike(band, asked[i].band)) of_bands[band] = solutions[i];
    of_bands[asked[i].band] = std::move(solutions[i]);
  }
}

void LeafField::compose() {
  result_ = {};
  // What a source's solution counts for in a band.
  struct Part {
    std::size_t source;
    glm::vec3 scale;
  };
  std::vector<Part> parts;
  for (std::size_t sun = 0; sun < lighting_.suns.size(); ++sun) parts.push_back({sun, lighting_.suns[sun].irradiance});
  if (lighting_.sky) parts.push_back({kSky, glm::vec3(1.f)});
  for (const Part& part : parts)
    for (std::size_t band = 0; band < kBands; ++band) {
      const FieldSolution& solution = solutions_[part.source][band];
      const auto scale = double{part.scale[static_cast<int>(band)]};
      FieldBalance& balance = result_.balance[band];
      balance.in += scale * solution.balance.in;
      balance.absorbed_leaves += scale * solution.balance.absorbed_leaves;
      balance.absorbed_wood += scale * solution.balance.absorbed_wood;
      balance.absorbed_ground += scale * solution.balance.absorbed_ground;
      balance.out_up += scale * solution.balance.out_up;
      balance.out_down += scale * solution.balance.out_down;
      result_.iterations = std::max(result_.iterations, solution.iterations);
      result_.error_bound = std::max(result_.error_bound, solution.error_bound);
      result_.converged = result_.converged && solution.converged;
    }
  std::vector<LeafLight> leaves(mesh_.leaf_count, LeafLight{});
  std::vector<float> areas(mesh_.leaf_count);
  for (std::size_t i = 0; i < elements_.leaf_elements; ++i) areas[elements_.leaf[i]] += elements_.area[i];
  for (std::size_t i = 0; i < elements_.leaf_elements; ++i) {
    LeafLight& leaf = leaves[elements_.leaf[i]];
    const float share = elements_.area[i] / areas[elements_.leaf[i]];
    for (const Part& part : parts)
      for (std::size_t band = 0; band < kBands; ++band) {
        const float scale = share * part.scale[static_cast<int>(band)];
        const std::vector<float>& scattered = solutions_[part.source][band].scattered;
        leaf.scattered[band].front += scale * scattered[2 * i];
        leaf.scattered[band].back += scale * scattered[2 * i + 1];
        if (part.source == kSky) continue;
        leaf.direct[band].front += scale * direct_[part.source].irradiance[2 * i];
        leaf.direct[band].back += scale * direct_[part.source].irradiance[2 * i + 1];
      }
  }
  for (std::size_t tree = 0; tree < stand_.trees.size(); ++tree)
    result_.trees.emplace_back(leaves.begin() + static_cast<std::ptrdiff_t>(first_leaf_[tree]),
                               leaves.begin() + static_cast<std::ptrdiff_t>(first_leaf_[tree + 1]));
}

}  // namespace sunfleck
