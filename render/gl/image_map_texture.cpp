#include "render/gl/image_map_texture.hpp"

#include <cmath>
#include <glm/geometric.hpp>

#include "render/shading/image_map.hpp"

namespace sunfleck::gl {
namespace {

using shading::ImageMap;

// Of all triangles of a tree.
std::vector<ImageMap> imageMaps(const TreeMesh& mesh, const TreeLevels& levels) {
  const std::vector<double> areas = leafAreas(mesh);
  std::vector<ImageMap> maps(levels.triangles.size());
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const std::size_t source = levels.sources[i];
    if (source >= mesh.leaf_triangles.size()) continue;
    const TriangleData& triangle = levels.triangles[i];
    maps[i] = shading::imageMap(mesh, source);
    const float enlargement = glm::length(glm::vec3(triangle.plane));
    if (i == source || !maps[i].known()) continue;
    const glm::uvec3& corners = mesh.leaf_triangles[source];
    // A leaf drawn larger is one of its triangles, about the leaf's middle (R25); others are as they are.
    const bool whole = i < mesh.leaf_triangles.size() || std::abs(enlargement - 1.f) < 1e-6f;
    if (whole) continue;
    const glm::vec3 middle = (mesh.vertices[corners.x] + mesh.vertices[corners.y] + mesh.vertices[corners.z]) / 3.f;
    const double larger = double{enlargement} * std::sqrt(areas[triangle.leaf] / triangleArea(mesh, corners));
    maps[i] = enlarged(maps[i], static_cast<float>(larger), middle, triangle.middle);
  }
  return maps;
}

}  // namespace

ImageMapTexture::ImageMapTexture() : maps_(BufferTexture::Texel::rgba32f, "the places of leaves in their maps take") {}

std::size_t ImageMapTexture::update(const DrawnStand& stand,
                                    const std::vector<std::shared_ptr<const TreeLevels>>& levels) {
  std::vector<Held> now(levels.size());
  std::size_t triangles = 0;
  for (std::size_t kind = 0; kind < now.size(); ++kind) {
    const TreeKind& tree = stand.kinds[kind].tree;
    if (!tree.maps || !tree.mesh || tree.mesh->patch_of_triangle.empty()) continue;
    now[kind] = {levels[kind], static_cast<std::uint32_t>(triangles + 1)};
    triangles += levels[kind]->triangles.size();
  }
  if (now == kinds_) return 0;
  kinds_.clear();
  static_assert(sizeof(ImageMap) == 2 * sizeof(glm::vec4));
  maps_.resize(2 * triangles);
  for (std::size_t kind = 0; kind < now.size(); ++kind)
    if (now[kind].levels) {
      const std::vector<ImageMap> maps = imageMaps(*stand.kinds[kind].tree.mesh, *now[kind].levels);
      maps_.write(2 * std::size_t{now[kind].first - 1}, std::span<const ImageMap>(maps));
    }
  kinds_ = std::move(now);
  return triangles * sizeof(ImageMap);
}

}  // namespace sunfleck::gl
