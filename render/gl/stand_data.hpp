#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "render/gl/buffer.hpp"
#include "render/gl/buffer_texture.hpp"
#include "render/gl/cell_atlas.hpp"
#include "render/gl/detail/frame_data.hpp"
#include "render/gl/drawn_stand.hpp"
#include "render/gl/field_texture.hpp"
#include "render/gl/image_map_texture.hpp"
#include "render/gl/leaf_place_texture.hpp"
#include "render/gl/map_pool.hpp"
#include "render/gl/radiance_texture.hpp"
#include "render/gl/tree_levels.hpp"
#include "render/gl/tree_mesh_buffers.hpp"
#include "render/shading/leaf_tables.hpp"

namespace sunfleck::gl {

// What an update sent to the graphics card [byte].
struct Sent {
  std::size_t meshes = 0, maps = 0, trees = 0, cells = 0, sky = 0, field = 0, leaves = 0;
  std::size_t all() const { return meshes + maps + trees + cells + sky + field + leaves; }
};

// The ground's disc [m].
struct GroundDisc {
  glm::vec3 centre{0.f};
  float radius = 0.f;
};

// A stand in the memory of the current context.
class StandData {
 public:
  StandData();
  // Sends what has changed since the last update. Throws TooLarge with the figure where OpenGL cannot hold it; the
  // stand is then not to be drawn.
  Sent update(const DrawnStand& stand);

  // For all shaders, as frame.glsl, foliage.glsl, cells.glsl and shade.frag read them.
  void bind() const;
  // What a frame's data say of the stand; the camera's are not set.
  const detail::FrameData& frame() const { return frame_; }

  struct Kind {
    std::shared_ptr<const TreeMesh> mesh;
    std::shared_ptr<const TreeLevels> levels = std::make_shared<const TreeLevels>();
    std::optional<TreeMeshBuffers> buffers;
    std::vector<detail::DrawnData> drawn;  // trees of this kind, copies included
  };
  const std::vector<Kind>& kinds() const { return kinds_; }
  const std::vector<TreeKind>& treeKinds() const { return tree_kinds_; }
  const std::vector<DrawnLight>& lights() const { return lights_; }
  // For shading by any model.
  const std::shared_ptr<const shading::LeafTables>& leafTables() const { return leaf_tables_; }
  bool litBySky() const { return lit_by_sky_; }
  // A drawn tree by its number.
  struct Seen {
    std::uint32_t tree = 0, kind = 0;
    glm::vec3 position{0.f};  // [m]
  };
  Seen seen(std::uint32_t drawn) const { return seen_[drawn]; }
  std::size_t drawnTrees() const { return seen_.size(); }
  Bounds box() const { return box_; }  // of all that is drawn but the ground [m]
  const GroundDisc& ground() const { return ground_; }

 private:
  std::size_t updateMeshes(const DrawnStand& stand);
  std::size_t updateLeaves(const DrawnStand& stand);
  void sendKindFrames(const DrawnStand& stand);
  std::size_t updateSky(const DrawnStand& stand);
  std::size_t updateTrees(const DrawnStand& stand);
  void placeGround(const DrawnStand& stand);
  std::size_t sendGrids(const DrawnStand& stand);

  std::vector<Kind> kinds_;
  std::vector<TreeKind> tree_kinds_;
  std::vector<DrawnLight> lights_;
  std::vector<std::uint32_t> first_triangle_;  // of each kind
  MapPool maps_;
  CellAtlas cells_;
  FieldTexture field_;
  std::shared_ptr<const shading::LeafTables> leaf_tables_ = std::make_shared<const shading::LeafTables>();
  LeafPlaceTexture leaf_places_;
  ImageMapTexture image_maps_;
  RadianceTexture sky_, ground_sky_;
  std::shared_ptr<const SkyMap> sent_sky_;
  std::uint64_t sent_ground_sky_ = 0;
  BufferTexture triangles_, light_cells_, light_casters_, trees_, drawn_;
  Buffer kind_frames_;
  std::vector<Seen> seen_;
  Bounds box_;
  GroundDisc ground_;
  bool lit_by_sky_ = false;
  detail::FrameData frame_;
};

}  // namespace sunfleck::gl
