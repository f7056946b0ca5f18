#pragma once

#include <list>
#include <memory>

#include "core/tree_mesh.hpp"
#include "render/gl/opacity_maps.hpp"

namespace sunfleck::gl {

// Opacity maps of trees along lights, made on the graphics card when they are first asked for and kept there while they
// are in use: of each tree those of the last few lights.
class OpacityMapStore {
 public:
  // As OpacityMapMaker's constructor and make(); what it returns stays until as many others as there may be lights have
  // been asked for of that tree.
  explicit OpacityMapStore(const Context& context) : maker_(context) {}
  const OpacityMap& map(const std::shared_ptr<const TreeMesh>& mesh, Direction along, int resolution);

  // The one that was made of that tree, if it is still there.
  const OpacityMap* find(const std::shared_ptr<const TreeMesh>& mesh, Direction along, int resolution) const;

 private:
  struct Kept {
    Direction along;
    int resolution;
    OpacityMap map;
    bool is(Direction of, int pixels) const { return along == of && resolution == pixels; }
  };
  struct Tree {
    std::shared_ptr<const TreeMesh> mesh;
    MappedTree mapped;
    std::list<Kept> maps;  // the last that was asked for first
  };
  OpacityMapMaker maker_;
  std::list<Tree> trees_;
};

}  // namespace sunfleck::gl
