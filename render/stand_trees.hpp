#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/stand.hpp"
#include "grid/foliage_stand.hpp"

namespace sunfleck {

// Which instance of a FoliageStand each tree of a stand is. A list of trees says nothing of what was added, moved or
// taken away since the last: trees that stand as before are found whatever their places in the lists, so that only what
// differs makes something stale.
class StandTrees {
 public:
  // Adds, moves and removes instances until they are the trees of the list.
  //   prototypes  of each tree
  void update(FoliageStand& foliage, std::span<const Placement> trees, std::span<const std::size_t> prototypes);

  std::size_t instance(std::size_t tree) const { return standing_[tree].instance; }

 private:
  struct Standing {
    std::size_t instance, prototype;
    glm::vec3 position;
  };
  std::vector<Standing> standing_;  // of each tree
  std::vector<Standing> gone_;      // removed, to be used again
};

}  // namespace sunfleck
