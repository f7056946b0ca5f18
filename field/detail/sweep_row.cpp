#include "field/detail/sweep_row.hpp"

#include "core/instruction_set.hpp"

namespace sunfleck {

SUNFLECK_BUILDS(detail::SweepRow, sweep_row)

detail::SweepRow detail::sweepRow() {
  return bestBuild();
}

}  // namespace sunfleck
