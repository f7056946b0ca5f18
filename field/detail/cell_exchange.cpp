#include "field/detail/cell_exchange.hpp"

#include "core/instruction_set.hpp"

namespace sunfleck {

namespace baseline {
extern const detail::CellExchange cell_exchange;
}
#ifdef SUNFLECK_X86
namespace avx2 {
extern const detail::CellExchange cell_exchange;
}
namespace avx512 {
extern const detail::CellExchange cell_exchange;
}
#endif

detail::CellExchange detail::cellExchange() {
#ifdef SUNFLECK_X86
  static const CellExchange best = bestOf({&baseline::cell_exchange, &avx2::cell_exchange, &avx512::cell_exchange});
#else
  static const CellExchange best = baseline::cell_exchange;
#endif
  return best;
}

}  // namespace sunfleck
