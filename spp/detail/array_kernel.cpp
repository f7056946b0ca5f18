#include "spp/detail/array_kernel.hpp"

#include "core/instruction_set.hpp"

namespace sunfleck::spp {

#ifdef SUNFLECK_X86
namespace avx512 {
extern const detail::ArrayKernel the_kernel;
}
namespace avx2 {
extern const detail::ArrayKernel the_kernel;
}
#endif
namespace baseline {
extern const detail::ArrayKernel the_kernel;
}

namespace detail {
namespace {

const ArrayKernel& choose() {
#ifdef SUNFLECK_X86
  switch (instructionSet()) {
    case InstructionSet::avx512:
      return avx512::the_kernel;
    case InstructionSet::avx2:
      return avx2::the_kernel;
    case InstructionSet::baseline:
      break;
  }
#endif
  return baseline::the_kernel;
}

}  // namespace

const ArrayKernel& arrayKernel() {
  static const ArrayKernel& chosen = choose();
  return chosen;
}

}  // namespace detail
}  // namespace sunfleck::spp
