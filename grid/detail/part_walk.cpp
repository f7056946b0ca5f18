#include "grid/detail/part_walk.hpp"

#include "core/instruction_set.hpp"

namespace sunfleck {

SUNFLECK_BUILDS(detail::PartWalk, part_walk)

detail::PartWalk detail::partWalk() {
  return bestBuild();
}

}  // namespace sunfleck
