#include "pp_solver/slab_batch.hpp"
