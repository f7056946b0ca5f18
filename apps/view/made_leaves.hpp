#pragma once

#include <memory>
#include <span>
#include <vector>

#include "grid/product_graph.hpp"
#include "render/scene.hpp"

namespace sunfleck::view {

// What follows from the textures of leaves, made anew only for kinds whose leaves are told otherwise than the last
// time. Only what the last scene had is kept: maps of large images take 70 bytes a place.
class MadeLeaves {
 public:
  // Sets the maps, the mean over them and the shares of leaf area of kinds with textures that have no maps yet. Throws
  // InvalidInput as setLeaves() does.
  void make(std::span<TreeKind> kinds, const LightBands& bands);
  const ProductCost& lastCost() const { return cost_; }  // of that

 private:
  std::vector<TreeKind> last_;  // those with textures
  ProductCost cost_;
};

}  // namespace sunfleck::view
