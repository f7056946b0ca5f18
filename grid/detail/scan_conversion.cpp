#include "grid/detail/scan_conversion.hpp"

#include "core/instruction_set.hpp"

namespace sunfleck {

namespace baseline {
extern const detail::ScanConversion scan_conversion;
}
#ifdef SUNFLECK_X86
namespace avx2 {
extern const detail::ScanConversion scan_conversion;
}
namespace avx512 {
extern const detail::ScanConversion scan_conversion;
}
#endif

detail::ScanConversion detail::scanConversion() {
#ifdef SUNFLECK_X86
  static const ScanConversion best =
      bestOf({&baseline::scan_conversion, &avx2::scan_conversion, &avx512::scan_conversion});
#else
  static const ScanConversion best = baseline::scan_conversion;
#endif
  return best;
}

}  // namespace sunfleck
