#include "pp_solver/leaf_angles.hpp"
