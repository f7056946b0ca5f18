#include "render/leaf_models.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <span>

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

// Adds to `sum` what each leaf of a block receives in one tree of the stand.
void addIrradiance(Model model, std::span<const float> projection, std::span<const float> depth,
                   std::span<const float> thickness, std::span<const float> compensation, const LeafOptics& optics,
                   std::span<float> sum) {
  std::array<float, kBlock> down, up;
  const std::size_t leaves = sum.size();
  if (model != Model::ss)
    spp::sppPowers(depth, thickness, kMu0, optics.albedo(),
                   spp::sphericalLeafForwardShare(optics.reflectance, optics.transmittance),
                   std::span(down).first(leaves), std::span(up).first(leaves));
  for (std::size_t i = 0; i < leaves; ++i) {
    const float direct = spp::directPower(depth[i], kMu0);
    spp::SlabPowers powers{.down = direct, .up = 0.f};
    if (model != Model::ss) powers = {.down = down[i], .up = up[i]};
    if (model == Model::sppg) powers = spp::compensated(powers, direct, compensation[i]);
    sum[i] += spp::leafIrradiance(projection[i], direct, powers);
  }
}

}  // namespace

LeafGeometry leafGeometry(const Scene& scene, const StandGeometry& stand, const Progress& progress) {
  const TreeMesh& mesh = *scene.kinds[0].mesh;
  const auto start = Clock::now();
  LeafGeometry geometry;
  geometry.projections = leafProjections(mesh, scene.sun().light());
  geometry.depths = leafDepths(mesh, stand.light(0, 0), scene.stand, progress);
  geometry.depth_seconds = secondsSince(start);

  const auto start_interpolation = Clock::now();
  const std::vector<glm::vec3> centres = leafCentres(mesh);
  for (std::size_t tree = 0; tree < scene.stand.trees.size(); ++tree) {
    const std::span<const float> of_cells = stand.compensation(tree, 0);
    std::vector<float>& of_leaves = geometry.compensation.emplace_back();
    of_leaves.reserve(centres.size());
    for (const glm::vec3& centre : centres) of_leaves.push_back(interpolate(stand.cells(0), of_cells, centre));
  }
  geometry.compensation_seconds = secondsSince(start_interpolation);
  return geometry;
}

std::vector<float> leafIrradiance(Model model, const LeafGeometry& geometry, const LeafOptics& optics) {
  const std::size_t trees = geometry.depths.size(), leaves = geometry.projections.size();
  std::vector<float> irradiance(leaves);
  tbb::parallel_for(std::size_t{0}, (leaves + kBlock - 1) / kBlock, [&](std::size_t block) {
    const std::size_t first = block * kBlock, count = std::min(kBlock, leaves - first);
    const auto part = [&](const std::vector<float>& all) { return std::span(all).subspan(first, count); };
    const std::span<float> sum = std::span(irradiance).subspan(first, count);
    for (std::size_t tree = 0; tree < trees; ++tree)
      addIrradiance(model, part(geometry.projections), part(geometry.depths[tree].depth),
                    part(geometry.depths[tree].thickness), part(geometry.compensation[tree]), optics, sum);
    for (float& value : sum) value /= static_cast<float>(trees);
  });
  return irradiance;
}

LeafDepths meanDepths(const LeafGeometry& geometry) {
  LeafDepths mean = geometry.depths.front();
  const auto trees = static_cast<float>(geometry.depths.size());
  for (std::size_t leaf = 0; leaf < mean.depth.size(); ++leaf) {
    for (std::size_t tree = 1; tree < geometry.depths.size(); ++tree) {
      mean.depth[leaf] += geometry.depths[tree].depth[leaf];
      mean.thickness[leaf] += geometry.depths[tree].thickness[leaf];
    }
    mean.depth[leaf] /= trees;
    mean.thickness[leaf] /= trees;
  }
  return mean;
}

}  // namespace sunfleck
