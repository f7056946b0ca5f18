#pragma once

#include "core/leaf_optics.hpp"
#include "spp/power_table.hpp"

namespace sunfleck {

// (R27) P+ and P- of the exact solution in slabs of leaves of all directions, lit across, as a table: solved on all
// threads that TBB may use, the same bits for any number of them.
spp::PowerTable exactPowerTable(const LeafOptics& optics);

}  // namespace sunfleck
