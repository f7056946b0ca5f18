#include "spp/detail/array_kernel.hpp"

#include "core/instruction_set.hpp"

namespace sunfleck::spp {

namespace baseline {
extern const detail::ArrayKernel the_kernel;
}
#ifdef SUNFLECK_X86
namespace avx2 {
extern const detail::ArrayKernel the_kernel;
}
namespace avx512 {
extern const detail::ArrayKernel the_kernel;
}
#endif

const detail::ArrayKernel& detail::arrayKernel() {
#ifdef SUNFLECK_X86
  static const ArrayKernel& best = bestOf({&baseline::the_kernel, &avx2::the_kernel, &avx512::the_kernel});
#else
  static const ArrayKernel& best = baseline::the_kernel;
#endif
  return best;
}

}  // namespace sunfleck::spp
