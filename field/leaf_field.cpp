#include "field/leaf_field.hpp"

#include <algorithm>
#include <numeric>

#include "core/require.hpp"
#include "field/ground_light.hpp"
#include "field/near_return.hpp"
#include "sky/sky_shares.hpp"

namespace sunfleck {
namespace {

constexpr std::array<std::size_t, 1> kOnly{0};

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
  graph_.follows(direct_product_, exchange_product_, all(kMostSuns));
  graph_.follows(recollision_product_, exchange_product_, all(1));
  graph_.follows(solution_product_, recollision_product_, all(kSources));
  graph_.follows(solution_product_, direct_product_,
                 [](std::size_t sun, const ProductGraph::Mark& mark) { mark(sun); });
  for (const auto product : {elements_product_, exchange_product_, recollision_product_}) graph_.resize(product, 1);
  graph_.resize(direct_product_, kMostSuns);
  graph_.resize(solution_product_, kSources);
}

bool LeafField::sameStand(std::span<const std::shared_ptr<const TreeMesh>> kinds, const Stand& stand) const {
  return stand == stand_ && std::equal(kinds.begin(), kinds.end(), meshes_.begin(), meshes_.end());
}
bool LeafField::sameOptics(const FieldLighting& lighting) const {
  return lighting.kinds == lighting_.kinds && lighting.ground_albedo == lighting_.ground_albedo;
}
bool LeafField::sameDirection(const FieldLighting& lighting, std::size_t sun) const {
  return sun < lighting_.suns.size() && lighting.suns[sun].along == lighting_.suns[sun].along;
}

void LeafField::setStand(std::span<const std::shared_ptr<const TreeMesh>> kinds, const Stand& stand) {
  requireFieldStand(kinds, stand);
  if (sameStand(kinds, stand)) return;
  meshes_.assign(kinds.begin(), kinds.end());
  stand_ = stand;
  lighting_.kinds.clear();  // what was told of others
  graph_.touchAll(elements_product_);
}

FieldGeometry LeafField::geometry() const {
  return {elements_.elements, exchange_, elements_.kinds, near_return_, stand_.period.has_value()};
}

bool LeafField::upToDate(std::span<const std::shared_ptr<const TreeMesh>> kinds, const Stand& stand,
                         const FieldLighting& lighting) const {
  if (!sameStand(kinds, stand) || !sameOptics(lighting)) return false;
  for (std::size_t sun = 0; sun < lighting.suns.size(); ++sun)
    if (!sameDirection(lighting, sun) || graph_.stale(solution_product_, sun)) return false;
  return !lighting.sky || (lighting.sky == lighting_.sky && !graph_.stale(solution_product_, kSky));
}

const FieldResult& LeafField::solve(const FieldLighting& lighting, const Progress& progress) {
  require(!meshes_.empty(), "number of trees", 0, "at least 1: setStand first");
  requireFieldLighting(lighting, meshes_.size());
  for (std::size_t sun = 0; sun < lighting.suns.size(); ++sun)
    if (!sameDirection(lighting, sun)) graph_.touch(direct_product_, sun);
  if (!sameOptics(lighting)) graph_.touchAll(recollision_product_);
  if (lighting.sky != lighting_.sky) graph_.touch(solution_product_, kSky);
  lighting_ = lighting;

  // How far it is, by how long parts take.
  constexpr double kExchange = 0.7, kDirect = 0.8;
  double done = graph_.stale(exchange_product_, 0) ? 0. : kExchange;
  requireGoOn(progress, done);
  graph_.bring(elements_product_, kOnly, [&](std::size_t) {
    elements_ = {};
    elements_ = standElements(meshes_, elementsOfKinds(meshes_, stand_, effort_.elements), stand_);
  });
  graph_.bring(exchange_product_, kOnly, [&](std::size_t) {
    exchange_ = {};  // its memory before that of the next
    exchange_ = lineExchange(elements_.mesh, elements_.elements, stand_.period, effort_.exchange,
                             partOf(progress, done, kExchange));
    near_return_ = nearReturn(elements_.elements, exchange_, elements_.kinds, 2 * meshes_.size());
  });
  std::vector<std::size_t> suns(lighting.suns.size());
  std::iota(suns.begin(), suns.end(), std::size_t{0});
  requireGoOn(progress, kExchange);
  graph_.bring(direct_product_, suns, [&](std::size_t sun) {
    const SunPicture picture(elements_.mesh, elements_.elements, stand_.period, lighting_.suns[sun].along,
                             effort_.direct);
    direct_[sun] = directLight(picture, elements_.elements, stand_.period.has_value());
    lit_[sun] = litPlaces(picture, direct_[sun], exchange_);
  });
  std::vector<std::size_t> sources = suns, stale;
  if (lighting.sky) sources.push_back(kSky);
  for (const std::size_t source : sources)
    if (graph_.stale(solution_product_, source)) stale.push_back(source);
  requireGoOn(progress, kDirect);
  if (!stale.empty()) makeSolutions(stale, partOf(progress, kDirect, 1.));
  graph_.bring(solution_product_, sources, [](std::size_t) {});
  result_ = fieldResult(elements_, parts());
  return result_;
}

void LeafField::makeSolutions(std::span<const std::size_t> stale, const Progress& progress) {
  const Stopwatch watch(graph_.cost(solution_product_).seconds);
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
      FieldProblem problem{.optics = optics[band], .ground_albedo = albedo};
      if (source == kSky) {
        problem.outside = outside[band];
        problem.ground_open = static_cast<float>(sky_irradiance[static_cast<int>(band)]);
      } else {
        problem.direct = &direct_[source];
        problem.lit = &lit_[source];
        problem.ground_open = -direct_[source].along.z;
      }
      problems.push_back(problem);
      asked.push_back({source, band});
    }
  // One for all bands, so that it is the same whichever sources are stale.
  std::vector<FieldProblem> all_bands;
  for (std::size_t band = 0; band < kBands; ++band)
    all_bands.push_back({.optics = optics[band], .ground_albedo = lighting_.ground_albedo[static_cast<int>(band)]});
  graph_.bring(recollision_product_, kOnly, [&](std::size_t) {
    albedo_ = largestAlbedo(all_bands);
    recollision_ = recollision(geometry(), albedo_, progress);
  });
  std::vector<FieldSolution> solutions = solveField(geometry(), problems, recollision_, effort_.solver, progress);
  for (std::size_t i = 0; i < asked.size(); ++i) {
    auto& of_bands = solutions_[asked[i].source];
    for (std::size_t band = asked[i].band + 1; band < kBands && asked[i].source != kSky; ++band)
      if (alike(band, asked[i].band)) of_bands[band] = solutions[i];
    of_bands[asked[i].band] = std::move(solutions[i]);
  }
}

std::vector<FieldPart> LeafField::parts() const {
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
std::vector<glm::vec3> LeafField::groundLight(const GroundGrid& grid) const {
  return sunfleck::groundLight(grid, stand_.period.has_value(), elements_, exchange_,
                               sentRadiance(elements_, parts(), lighting_.kinds));
}

}  // namespace sunfleck
