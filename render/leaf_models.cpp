#include "render/leaf_models.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <span>
#include <stdexcept>

#include "grid/cell_grid.hpp"
#include "spp/slab.hpp"
#include "spp/slab_arrays.hpp"

namespace sunfleck {
namespace {

using Clock = std::chrono::steady_clock;
double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

constexpr float kMu0 = 1.f;  // the slab's normal is the light's axis
// Leaves whose powers are computed at once: few enough to stay in the nearest cache.
constexpr std::size_t kBlock = 1024;

// P+, direct light included, and P- of a model before G.
class ModelPowers {
 public:
  ModelPowers(Model model, const LeafOptics& optics, const spp::PowerTableOf& exact) : model_(model), optics_(optics) {
    if (model == Model::nstreamg) {
      constants_ = spp::nStreamConstants(spp::sphericalLeaves(optics), kStreams, 1);
      streams_.emplace(*constants_);
    }
    if (model == Model::sppr) table_ = spp::refinedPowerTable(optics);
    if (model == Model::pp) {
      if (!exact) throw std::invalid_argument("the model pp needs the exact solution");
      table_ = exact(optics);
    }
  }

  void operator()(std::span<const float> depth, std::span<const float> thickness, std::span<float> down,
                  std::span<float> up) const {
    switch (model_) {
      case Model::ss:
      case Model::field:
        for (std::size_t i = 0; i < depth.size(); ++i) {
          down[i] = spp::directPower(depth[i], kMu0);
          up[i] = 0.f;
        }
        break;
      case Model::spp:
      case Model::sppg:
        spp::sppPowers(depth, thickness, kMu0, optics_.albedo(),
                       spp::sphericalLeafForwardShare(optics_.reflectance, optics_.transmittance), down, up);
        break;
      case Model::nstreamg:
        inAreaIndex(depth, thickness, down, up);
        break;
      case Model::sppr:
      case Model::pp:
        for (std::size_t i = 0; i < depth.size(); ++i) {
          const spp::SlabPowers diffuse = table_.at(depth[i], thickness[i]);
          down[i] = spp::directPower(depth[i], kMu0) + diffuse.down;
          up[i] = diffuse.up;
        }
        break;
    }
  }

 private:
  static constexpr int kStreams = 2;

  // The streams' depth is leaf area index.
  void inAreaIndex(std::span<const float> depth, std::span<const float> thickness, std::span<float> down,
                   std::span<float> up) const {
    const auto per_crossing = static_cast<float>(1. / constants_->beam_projection);
    std::array<float, kBlock> area_before, area;
    for (std::size_t i = 0; i < depth.size(); ++i) {
      area_before[i] = per_crossing * depth[i];
      area[i] = per_crossing * thickness[i];
    }
    streams_->powers(std::span(area_before).first(depth.size()), std::span(area).first(depth.size()), down, up);
  }

  Model model_;
  LeafOptics optics_;
  std::optional<spp::StreamConstants> constants_;
  std::optional<spp::StreamArrays> streams_;
  spp::PowerTable table_;
};

// Adds to `sum` what each leaf of a block receives in one tree of the stand.
void addIrradiance(const ModelPowers& model, std::span<const float> projection, std::span<const float> depth,
                   std::span<const float> thickness, std::span<const float> compensation, std::span<float> sum) {
  std::array<float, kBlock> down, up;
  const std::size_t leaves = sum.size();
  model(depth, thickness, std::span(down).first(leaves), std::span(up).first(leaves));
  for (std::size_t i = 0; i < leaves; ++i) {
    const float direct = spp::directPower(depth[i], kMu0);
    spp::SlabPowers powers{.down = down[i], .up = up[i]};
    if (!compensation.empty()) powers = spp::compensated(powers, direct, compensation[i]);
    sum[i] += spp::leafIrradiance(projection[i], direct, powers);
  }
}

}  // namespace

LeafGeometry leafGeometry(const Scene& scene, const StandGeometry& stand, const Progress& progress) {
  const auto start = Clock::now();
  LeafGeometry geometry;
  std::vector<LitKind> lit;
  for (std::size_t kind = 0; kind < stand.kinds().size(); ++kind) {
    const bool stands = stand.kinds()[kind].stands;
    if (stands) lit.push_back({stand.kinds()[kind].mesh.get(), &stand.light(kind, 0)});
    geometry.projections.push_back(stands ? leafProjections(*stand.kinds()[kind].mesh, scene.sun().light())
                                          : std::vector<float>{});
  }
  Stand by_kinds = scene.stand;  // of those that stand
  for (std::size_t tree = 0; tree < by_kinds.trees.size(); ++tree) {
    const std::size_t kind = stand.kindOf(tree);
    geometry.kind_of_tree.push_back(kind);
    geometry.scene_kind_of_tree.push_back(scene.stand.trees[tree].kind);
    by_kinds.trees[tree].kind = static_cast<std::uint32_t>(
        std::count_if(stand.kinds().begin(), stand.kinds().begin() + static_cast<std::ptrdiff_t>(kind),
                      [](const StandKind& before) { return before.stands; }));
  }
  geometry.first_leaf.push_back(0);
  for (const TreeKind& kind : scene.kinds)
    geometry.first_leaf.push_back(geometry.first_leaf.back() + kind.mesh->leaf_count);
  geometry.depths = leafDepths(lit, by_kinds, progress);
  geometry.depth_seconds = secondsSince(start);

  const auto start_interpolation = Clock::now();
  std::vector<std::vector<glm::vec3>> centres;
  for (const StandKind& kind : stand.kinds())
    centres.push_back(kind.stands ? leafCentres(*kind.mesh) : std::vector<glm::vec3>{});
  for (std::size_t tree = 0; tree < geometry.kind_of_tree.size(); ++tree) {
    const std::size_t kind = geometry.kind_of_tree[tree];
    const std::span<const float> of_cells = stand.compensation(tree, 0);
    std::vector<float>& of_leaves = geometry.compensation.emplace_back();
    if (of_cells.empty()) continue;
    of_leaves.reserve(centres[kind].size());
    for (const glm::vec3& centre : centres[kind]) of_leaves.push_back(interpolate(stand.cells(kind), of_cells, centre));
  }
  geometry.compensation_seconds = secondsSince(start_interpolation);
  return geometry;
}

std::vector<float> leafIrradiance(Model model, const LeafGeometry& geometry, std::span<const LeafOptics> optics,
                                  const spp::PowerTableOf& exact) {
  std::vector<float> irradiance(geometry.first_leaf.back());
  for (std::uint32_t kind = 0; kind < optics.size(); ++kind) {
    const ModelPowers powers(model, optics[kind], exact);
    const std::size_t begin = geometry.first_leaf[kind], leaves = geometry.first_leaf[kind + 1] - begin;
    const auto trees = static_cast<float>(std::ranges::count(geometry.scene_kind_of_tree, kind));
    tbb::parallel_for(std::size_t{0}, (leaves + kBlock - 1) / kBlock, [&](std::size_t block) {
      const std::size_t first = block * kBlock, count = std::min(kBlock, leaves - first);
      const auto part = [&](const std::vector<float>& all) { return std::span(all).subspan(first, count); };
      const std::span<float> sum = std::span(irradiance).subspan(begin + first, count);
      for (std::size_t tree = 0; tree < geometry.depths.size(); ++tree)
        if (geometry.scene_kind_of_tree[tree] == kind)
          addIrradiance(powers, part(geometry.projections[geometry.kind_of_tree[tree]]),
                        part(geometry.depths[tree].depth), part(geometry.depths[tree].thickness),
                        needsCompensation(model) ? part(geometry.compensation[tree]) : std::span<const float>(), sum);
      for (float& value : sum) value /= trees;
    });
  }
  return irradiance;
}

LeafDepths meanDepths(const LeafGeometry& geometry) {
  const std::size_t kinds = geometry.first_leaf.size() - 1, leaves = geometry.first_leaf.back();
  LeafDepths mean{.depth = std::vector<float>(leaves), .thickness = std::vector<float>(leaves)};
  std::vector<float> trees(kinds, 0.f);
  for (std::size_t tree = 0; tree < geometry.depths.size(); ++tree) {
    const std::uint32_t kind = geometry.scene_kind_of_tree[tree];
    ++trees[kind];
    for (std::size_t leaf = 0; leaf < geometry.depths[tree].depth.size(); ++leaf) {
      mean.depth[geometry.first_leaf[kind] + leaf] += geometry.depths[tree].depth[leaf];
      mean.thickness[geometry.first_leaf[kind] + leaf] += geometry.depths[tree].thickness[leaf];
    }
  }
  for (std::size_t kind = 0; kind < kinds; ++kind)
    for (std::size_t leaf = geometry.first_leaf[kind]; leaf < geometry.first_leaf[kind + 1]; ++leaf) {
      mean.depth[leaf] /= trees[kind];
      mean.thickness[leaf] /= trees[kind];
    }
  return mean;
}

}  // namespace sunfleck
