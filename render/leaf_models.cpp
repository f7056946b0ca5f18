#include "render/leaf_models.hpp"

#include <tbb/parallel_for.h>

#include <chrono>

#include "grid/instance_cells.hpp"
#include "grid/neighbours.hpp"
#include "spp/slab.hpp"

namespace sunfleck {
namespace {

using Clock = std::chrono::steady_clock;
double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

constexpr float kMu0 = 1.f;  // the slab's normal is the light's axis
// Leaves of all orientations whose reflectance and transmittance are alike send as much on into the light's forward
// half as back: the paper's experiment. For other leaves it is an approximation.
constexpr float kForwardShare = 0.5f;

float irradianceOf(Model model, float projection, float depth, float thickness, float compensation, float albedo) {
  const float direct = spp::directPower(depth, kMu0);
  if (model == Model::ss) return spp::leafIrradiance(projection, direct, {.down = direct, .up = 0.f});
  const spp::SlabPowers slab = spp::sppPowers(depth, thickness, kMu0, albedo, kForwardShare);
  const float g = model == Model::sppg ? compensation : 1.f;
  return spp::leafIrradiance(projection, direct, spp::compensated(slab, direct, g));
}

}  // namespace

LeafGeometry leafGeometry(const Scene& scene, const StandGeometry& stand) {
  const TreeMesh& mesh = *scene.tree;
  const auto start = Clock::now();
  LeafGeometry geometry;
  geometry.projections = leafProjections(mesh, scene.sun());
  const std::size_t trees = scene.stand.trees.size();
  geometry.depths.resize(trees);
  tbb::parallel_for(std::size_t{0}, trees, [&](std::size_t tree) {
    geometry.depths[tree] =
        leafDepths(mesh, stand.light, neighbourDisplacements(scene.stand, stand.cells.leaves, tree));
  });
  geometry.depth_seconds = secondsSince(start);

  const auto start_interpolation = Clock::now();
  const std::vector<glm::vec3> centres = leafCentres(mesh);
  for (const std::vector<float>& of_cells : stand.compensation) {
    std::vector<float>& of_leaves = geometry.compensation.emplace_back();
    of_leaves.reserve(centres.size());
    for (const glm::vec3& centre : centres) of_leaves.push_back(interpolate(stand.cells, of_cells, centre));
  }
  geometry.compensation_seconds = secondsSince(start_interpolation);
  return geometry;
}

std::vector<float> leafIrradiance(Model model, const LeafGeometry& geometry, const LeafOptics& optics) {
  const std::size_t trees = geometry.depths.size();
  std::vector<float> irradiance(geometry.projections.size());
  tbb::parallel_for(std::size_t{0}, irradiance.size(), [&](std::size_t leaf) {
    float sum = 0.f;
    for (std::size_t tree = 0; tree < trees; ++tree)
      sum += irradianceOf(model, geometry.projections[leaf], geometry.depths[tree].depth[leaf],
                          geometry.depths[tree].thickness[leaf], geometry.compensation[tree][leaf], optics.albedo());
    irradiance[leaf] = sum / static_cast<float>(trees);
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
