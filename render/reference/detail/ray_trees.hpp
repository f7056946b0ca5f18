#pragma once

#include <vector>

#include "core/bounds.hpp"
#include "render/reference/detail/facet.hpp"
#include "render/reference/detail/ray_tree_nodes.hpp"
#include "render/reference/detail/stand_copies.hpp"

namespace sunfleck::detail {

// (R36) Trees of boxes around the facets of each kind of tree, and one around the copies: what single rays meet, in 0.7
// of the time that Embree takes, on machines with vectors of 16 numbers. There are none where a kind has masks, and on
// other machines: Embree is asked there.
class RayTrees {
 public:
  static bool suitMachine();
  //   kinds  facets of each kind of tree, about its pivot
  RayTrees(const std::vector<std::vector<Facet>>& kinds, const std::vector<Copy>& copies);

  // First facet before `reach` [m] along the unit vector `direction`; whether there is any.
  bool closest(const glm::vec3& from, const glm::vec3& direction, float reach, FacetMet& met) const {
    return !empty_ && closest_(view(), &from.x, &direction.x, reach, met);
  }
  bool blocked(const glm::vec3& from, const glm::vec3& direction, float reach) const {
    return !empty_ && any_(view(), &from.x, &direction.x, reach);
  }

 private:
  struct FacetTree {
    std::vector<BoxNode> nodes;
    std::vector<FacetLeaf> leaves;
  };
  RayTreesView view() const { return {top_.empty() ? nullptr : top_.data(), copies_.data(), views_.data()}; }

  std::vector<FacetTree> trees_;  // of each kind
  std::vector<FacetTreeView> views_;
  std::vector<PlacedTree> copies_;
  std::vector<BoxNode> top_;
  bool empty_ = false;
  ClosestFacet* closest_ = nullptr;
  AnyFacet* any_ = nullptr;
};

}  // namespace sunfleck::detail
