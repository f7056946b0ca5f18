#include "spp/detail/array_kernel.hpp"

#include "core/instruction_set.hpp"

namespace sunfleck::spp {

SUNFLECK_BUILDS(detail::ArrayKernel, the_kernel)

const detail::ArrayKernel& detail::arrayKernel() {
  return bestBuild();
}

}  // namespace sunfleck::spp
