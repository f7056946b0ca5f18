#include "field/detail/sweep_row.hpp"

#include "core/instruction_set.hpp"

namespace sunfleck {

namespace baseline {
extern const detail::SweepRow sweep_row;
}
#ifdef SUNFLECK_X86
namespace avx2 {
extern const detail::SweepRow sweep_row;
}
namespace avx512 {
extern const detail::SweepRow sweep_row;
}
#endif

detail::SweepRow detail::sweepRow() {
#ifdef SUNFLECK_X86
  static const SweepRow best = bestOf({&baseline::sweep_row, &avx2::sweep_row, &avx512::sweep_row});
#else
  static const SweepRow best = baseline::sweep_row;
#endif
  return best;
}

}  // namespace sunfleck
