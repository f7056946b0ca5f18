#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/bounds.hpp"
#include "core/stand.hpp"
#include "core/tree_mesh.hpp"
#include "render/reference/trace_medium.hpp"

namespace sunfleck {

// A stand of trees, and of media, that Embree traces rays through. Trees of a kind share its geometry; threads share a
// RayScene.
class RayScene {
 public:
  //   kinds      prototypes of the kinds of trees; of each stands one at least. Leaves are numbered through all of them
  //   with_wood  whether wood stops light; without it the leaves stand alone
  //   media      what stands between the trees; a kind may then be a tree without leaves, or without anything
  // Throws InvalidInput on a stand without trees, a kind without trees, a placement or period that is not finite, a
  // period <= 0 or one so small that more than a million copies of the trees reach into it, and as validate() does on
  // media.
  RayScene(std::span<const TreeMesh* const> kinds, const Stand& stand, bool with_wood,
           const std::vector<TraceMedium>& media = {});
  RayScene(const TreeMesh& mesh, const Stand& stand, bool with_wood);                       // trees of one kind
  RayScene(const std::vector<TraceMedium>& media, const std::optional<glm::vec2>& period);  // no trees
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;

  // Of everything that can be hit [m]. If periodic: in x and y one period around the middle of the stand, in z the
  // height of its trees.
  const Bounds& box() const;

  // (R5) Exact number of leaf crossings on the line from `from` along `direction` without end: the check of the deep
  // opacity maps. A leaf that the line meets on an edge shared by two of its triangles is crossed once. Wood is passed
  // through; leaf `own`, in any tree, is not counted. Throws InvalidInput for a periodic stand, where the number may
  // be infinite. Media have no leaves to count.
  static constexpr std::uint32_t kNoLeaf = ~0u;
  int crossings(glm::vec3 from, glm::vec3 direction, std::uint32_t own = kNoLeaf) const;

  struct Geometry;  // Embree's scenes; complete in render/reference/ alone
  const Geometry& geometry() const { return *geometry_; }

 private:
  std::unique_ptr<Geometry> geometry_;
};

}  // namespace sunfleck
