#include "pp_solver/detail/state.hpp"
