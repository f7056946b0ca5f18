#include "grid/detail/part_walk.hpp"

#include "core/instruction_set.hpp"

namespace sunfleck {

namespace baseline {
extern const detail::PartWalk part_walk;
}
#ifdef SUNFLECK_X86
namespace avx2 {
extern const detail::PartWalk part_walk;
}
namespace avx512 {
extern const detail::PartWalk part_walk;
}
#endif

detail::PartWalk detail::partWalk() {
#ifdef SUNFLECK_X86
  static const PartWalk best = bestOf({&baseline::part_walk, &avx2::part_walk, &avx512::part_walk});
#else
  static const PartWalk best = baseline::part_walk;
#endif
  return best;
}

}  // namespace sunfleck
