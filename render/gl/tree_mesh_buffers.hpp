#pragma once

#include "render/gl/buffer.hpp"
#include "render/gl/object_name.hpp"
#include "render/gl/tree_levels.hpp"
#include "render/gl/visible_trees.hpp"

namespace sunfleck::gl {

// The triangles of a kind of tree, ready to be drawn by visible.vert.
class TreeMeshBuffers {
 public:
  explicit TreeMeshBuffers(const TreeLevels& levels);
  void draw(const VisibleTrees& visible) const;

 private:
  static void destroy(unsigned name);
  Buffer vertices_, indices_;
  ObjectName<&TreeMeshBuffers::destroy> array_;
};

}  // namespace sunfleck::gl
