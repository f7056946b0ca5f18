#include "grid/detail/scan_conversion.hpp"

#include "core/instruction_set.hpp"

namespace sunfleck {

SUNFLECK_BUILDS(detail::ScanConversion, scan_conversion)

detail::ScanConversion detail::scanConversion() {
  return bestBuild();
}

}  // namespace sunfleck
