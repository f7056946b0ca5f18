#include "field/field_lighting.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "core/finished_mesh.hpp"
#include "core/require.hpp"

namespace sunfleck {
namespace {

void requireShare(float value, const std::string& what) {
  require(value >= 0.f && value <= 1.f, what, value, "0 .. 1");
}

}  // namespace

void requireFieldStand(std::span<const std::shared_ptr<const TreeMesh>> kinds, const Stand& stand) {
  require(!stand.trees.empty(), "number of trees", stand.trees.size(), "at least 1");
  for (std::size_t i = 0; i < stand.trees.size(); ++i) {
    const Placement& tree = stand.trees[i];
    const std::string name = "tree " + std::to_string(i + 1);
    require(tree.kind < kinds.size(), name + " kind", tree.kind, "below the number of kinds");
    for (int axis = 0; axis < 3; ++axis)
      require(std::abs(tree.position[axis]) <= 1e6f, name + " position", tree.position[axis],
              "finite and at most 1e6 m in size");
    require(std::isfinite(tree.rotation), name + " rotation", tree.rotation, "finite");
    require(kinds[tree.kind]->masks.empty(), name + " leaf masks", kinds[tree.kind]->masks.size(),
            "0: the field would take the whole triangles");
  }
  for (std::size_t kind = 0; kind < kinds.size(); ++kind)
    if (std::ranges::count(stand.trees, kind, &Placement::kind) > 0)
      requireFinished(*kinds[kind], "kind " + std::to_string(kind + 1) + " of trees");
  if (stand.period)
    for (int axis = 0; axis < 2; ++axis)
      require((*stand.period)[axis] > 0.f && (*stand.period)[axis] <= 1e6f, "period", (*stand.period)[axis],
              "above 0 and at most 1e6 m");
}

void requireFieldLighting(const FieldLighting& lighting, std::size_t kinds) {
  require(lighting.suns.size() <= kMostFieldSuns, "number of suns", lighting.suns.size(), "at most 4");
  require(lighting.kinds.size() == kinds, "number of kinds with optics", lighting.kinds.size(), "that of the stand");
  for (const FieldSun& sun : lighting.suns) {
    require(std::abs(glm::length(sun.along) - 1.f) < 1e-3f, "length of the sunlight's direction",
            glm::length(sun.along), "1");
    require(sun.along.z < 0.f, "z of the sunlight's direction", sun.along.z, "below 0");
    for (int band = 0; band < kBands; ++band)
      require(sun.irradiance[band] >= 0.f && std::isfinite(sun.irradiance[band]), "sun irradiance",
              sun.irradiance[band], "finite and >= 0");
  }
  for (const FieldKind& kind : lighting.kinds)
    for (int band = 0; band < kBands; ++band) {
      validate(kind.leaf[static_cast<std::size_t>(band)]);
      requireShare(kind.wood_reflectance[band], "wood reflectance");
    }
  for (int band = 0; band < kBands; ++band) requireShare(lighting.ground_albedo[band], "ground albedo");
}

}  // namespace sunfleck
