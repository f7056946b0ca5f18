#include "apps/view/made_leaves.hpp"

#include <algorithm>
#include <utility>

#include "core/elapsed.hpp"

namespace sunfleck::view {

void MadeLeaves::make(std::span<TreeKind> kinds, const LightBands& bands) {
  const Elapsed elapsed;
  ProductCost cost{.name = "leaf maps"};
  std::vector<TreeKind> made;
  for (TreeKind& kind : kinds) {
    if (!kind.textures.any()) continue;
    const auto same_mesh = [&](const TreeKind& other) { return other.mesh == kind.mesh; };
    const auto same = [&](const TreeKind& other) {
      return same_mesh(other) && other.even == kind.even && other.description == kind.description &&
             other.textures == kind.textures;
    };
    const auto known = std::ranges::find_if(last_, same);
    if (kind.maps) {
      ++cost.reused;
    } else if (known != last_.end()) {
      kind.maps = known->maps;
      kind.shares = known->shares;
      kind.leaf = known->leaf;
      ++cost.reused;
    } else {
      if (const auto of_mesh = std::ranges::find_if(last_, same_mesh); of_mesh != last_.end())
        kind.shares = of_mesh->shares;
      setLeaves(kind, bands, kind.told());
      ++cost.made;
    }
    made.push_back(kind);
  }
  last_ = std::move(made);
  cost.seconds = elapsed.seconds();
  cost_ = std::move(cost);
}

}  // namespace sunfleck::view
