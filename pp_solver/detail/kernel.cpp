#include "pp_solver/detail/kernel.hpp"

#include "core/instruction_set.hpp"

namespace sunfleck::pp {

SUNFLECK_BUILDS(detail::Kernel, the_kernel)

const detail::Kernel& detail::kernel() {
  return bestBuild();
}

}  // namespace sunfleck::pp
