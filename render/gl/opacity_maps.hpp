#pragma once

#include <cstddef>

#include "core/directions.hpp"
#include "core/tree_mesh.hpp"
#include "grid/deep_opacity_map.hpp"
#include "render/gl/buffer.hpp"
#include "render/gl/context.hpp"
#include "render/gl/program.hpp"

namespace sunfleck::gl {

// A deep opacity map in the current context's memory, as foliage.glsl reads it.
struct OpacityMap {
  OpacityMapFrame frame;
  Buffer lines;      // of each pixel: its first crossing, the end of its crossings, the bits of the first wood's depth
  Buffer crossings;  // the bits of the depth, the leaf

  DeepOpacityMap read() const;  // the same in the program's memory
};

// The leaves and the wood of a tree in the current context's memory, for the maps along any direction.
class MappedTree {
 public:
  // `mesh` must outlive it.
  explicit MappedTree(const TreeMesh& mesh);

 private:
  friend class OpacityMapMaker;
  const TreeMesh* mesh_;
  float longest_edge_;  // of a triangle [m]
  Buffer positions_, triangles_;
};

// (D14) Makes deep opacity maps on the graphics card: the pixels, crossings and depths of DeepOpacityMap (D3), to the
// bit but where double precision rounds a corner of a pixel's centre to the other side of an edge.
class OpacityMapMaker {
 public:
  // A `context` must be current wherever it is used, and outlive it.
  explicit OpacityMapMaker(const Context& context);

  // As DeepOpacityMap's constructor. Throws TooLarge where an array of the tree or the map is larger than shaders
  // may read in one piece.
  OpacityMap make(const MappedTree& tree, Direction along, int resolution) const;

 private:
  const Context* context_;
  Program count_, sum_, fill_, sort_;
};

}  // namespace sunfleck::gl
