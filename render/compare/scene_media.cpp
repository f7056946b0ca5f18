#include "render/compare/scene_media.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <glm/mat3x3.hpp>

#include "core/available_memory.hpp"
#include "core/require.hpp"
#include "grid/density_grid.hpp"
#include "scattering/leaf_angles.hpp"

namespace sunfleck {
namespace {

ProjectedArea projectedArea(const LeafOrientation& m) {
  const glm::mat3 moments(m.xx, m.xy, m.xz, m.xy, m.yy, m.yz, m.xz, m.yz, m.zz());
  const glm::mat3 s = (5.f * moments + 3.f * moments * moments) / 8.f;
  return {s[0][0], s[1][1], s[2][2], s[0][1], s[0][2], s[1][2]};
}

std::vector<LeafRing> ringsOf(const std::string& angles) {
  std::vector<LeafRing> rings;
  if (angles.empty() || angles == "spherical") return rings;  // all directions alike
  for (const LeafAngles::Node& node : LeafAngles::named(angles).nodes())
    rings.push_back({static_cast<float>(node.cosine), static_cast<float>(node.weight)});
  return rings;
}

// Box of the leaves of all trees of a kind.
Bounds leafBoundsOf(const Scene& scene, std::size_t kind) {
  const TreeMesh& mesh = *scene.kinds[kind].mesh;
  Bounds box;
  for (const Placement& tree : scene.stand.trees) {
    if (tree.kind != kind) continue;
    const float cosine = std::cos(tree.rotation), sine = std::sin(tree.rotation);
    for (const glm::uvec3& triangle : mesh.leaf_triangles)
      for (int corner = 0; corner < 3; ++corner) {
        const glm::vec3& v = mesh.vertices[triangle[corner]];
        box.include(tree.position + glm::vec3(cosine * v.x - sine * v.y, sine * v.x + cosine * v.y, v.z));
      }
  }
  return box;
}

}  // namespace

MediumVoxels mediumVoxels(const DensityGrid& grid, float scale, bool oriented) {
  // Here and where rays pass it.
  const double bytes = static_cast<double>(grid.blocks()) * MediumVoxels::kCells *
                       (2. * sizeof(float) + (oriented ? 2. * sizeof(ProjectedArea) : 0.));
  require(bytes <= availableMemory(), "cells of a medium: memory in bytes", bytes,
          "no more than there is: make the cells larger");
  MediumVoxels voxels{.corner = grid.corner(), .cell_size = grid.cellSize()};
  grid.visitBlocks([&](const DensityGrid::Block& block) {
    voxels.blocks.push_back(block.first / MediumVoxels::kSide);
    for (std::size_t i = 0; i < MediumVoxels::kCells; ++i) {
      voxels.density.push_back(scale * block.density[i]);
      if (oriented) voxels.leaves.push_back(projectedArea(block.orientation[i]));
    }
  });
  return voxels;
}

std::vector<TraceMedium> traceMedia(const Scene& scene) {
  std::vector<TraceMedium> media;
  for (const SceneMedium& medium : scene.media) {
    if (!scene.stand.period && !medium.grid && !std::isfinite(medium.box.low.x))
      throw InvalidInput(scene.origin + ": a medium without box or file: must be in a periodic stand");
    TraceMedium& made = media.emplace_back();
    made.scatterer = medium.particles ? TraceMedium::Scatterer::particles : TraceMedium::Scatterer::leaves;
    made.asymmetry = medium.asymmetry;
    made.rings = ringsOf(medium.angles);
    if (medium.grid) {
      const bool oriented = !medium.particles && medium.angles.empty() && medium.grid->hasOrientation();
      made.voxels = mediumVoxels(*medium.grid, medium.density, oriented);
    } else {
      made.density = medium.density;
    }
    made.box = medium.box;
  }
  return media;
}

Scene turbid(const Scene& scene, float cell_size, const Progress& progress) {
  Scene made = scene;
  for (std::size_t kind = 0; kind < scene.kinds.size(); ++kind) {
    const TreeKind& of = scene.kinds[kind];
    if (of.mesh->leaf_count == 0) continue;
    Stand trees{.trees = {}, .period = scene.stand.period};
    for (Placement tree : scene.stand.trees)
      if (tree.kind == kind) {
        tree.kind = 0;
        trees.trees.push_back(tree);
      }
    const auto grid = std::make_shared<const DensityGrid>(
        DensityGrid::voxelizeStand(std::array<const TreeMesh*, 1>{of.mesh.get()}, trees, cell_size, {}, progress));
    SceneMedium& leaves =
        made.media.emplace_back(SceneMedium{.optics = of.leaf, .density = 1.f, .grid = grid, .source = of.source});
    // No wider than the leaves are, so that as much light meets it; but not flat.
    const Bounds box = leafBoundsOf(scene, kind);
    for (int axis = scene.stand.period ? 2 : 0; axis < 3; ++axis) {
      if (box.size()[axis] < 1e-3f * cell_size) continue;
      leaves.box.low[axis] = box.low[axis];
      leaves.box.high[axis] = box.high[axis];
    }
    TreeMesh wood = *of.mesh;
    wood.leaf_triangles.clear();
    wood.leaf_of_triangle.clear();
    wood.leaf_count = 0;
    made.kinds[kind].mesh = std::make_shared<const TreeMesh>(std::move(wood));
  }
  return made;
}

}  // namespace sunfleck
