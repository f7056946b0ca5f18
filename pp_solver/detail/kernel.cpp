#include "pp_solver/detail/kernel.hpp"

#include "core/instruction_set.hpp"

namespace sunfleck::pp {

namespace baseline {
extern const detail::Kernel the_kernel;
}
#ifdef SUNFLECK_X86
namespace avx2 {
extern const detail::Kernel the_kernel;
}
namespace avx512 {
extern const detail::Kernel the_kernel;
}
#endif

const detail::Kernel& detail::kernel() {
#ifdef SUNFLECK_X86
  static const Kernel& best = bestOf({&baseline::the_kernel, &avx2::the_kernel, &avx512::the_kernel});
#else
  static const Kernel& best = baseline::the_kernel;
#endif
  return best;
}

}  // namespace sunfleck::pp
