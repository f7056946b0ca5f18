#pragma once

#include <glm/vec3.hpp>
#include <memory>

#include "core/bounds.hpp"
#include "core/stand.hpp"
#include "core/tree_mesh.hpp"

namespace sunfleck {

// A stand of trees that Embree traces rays through. Copies share the geometry; threads share a RayScene.
class RayScene {
 public:
  // `with_wood`: whether wood stops light; without it the leaves stand alone.
  RayScene(const TreeMesh& mesh, const Stand& stand, bool with_wood);
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;

  const Bounds& box() const;  // of everything that can be hit; of one period, if periodic [m]

  // (R5) Exact number of leaf crossings on the line from `from` along `direction` without end: the check of the deep
  // opacity maps. Not for periodic stands.
  int crossings(glm::vec3 from, glm::vec3 direction) const;

  struct Geometry;  // Embree's scenes; complete in render/reference/ alone
  const Geometry& geometry() const { return *geometry_; }

 private:
  std::unique_ptr<Geometry> geometry_;
};

}  // namespace sunfleck
