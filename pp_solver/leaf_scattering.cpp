#include "pp_solver/leaf_scattering.hpp"
