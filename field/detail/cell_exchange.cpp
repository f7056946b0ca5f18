#include "field/detail/cell_exchange.hpp"

#include "core/instruction_set.hpp"

namespace sunfleck {

SUNFLECK_BUILDS(detail::CellExchange, cell_exchange)

detail::CellExchange detail::cellExchange() {
  return bestBuild();
}

}  // namespace sunfleck
