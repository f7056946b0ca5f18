#pragma once

#include <string>
#include <vector>

#include "pp_solver/problem.hpp"

namespace sunfleck::apps {

// Layers from a CSV file with the header thickness,omega,g, from the top down. Throws InvalidInput naming file and
// line.
std::vector<pp::Layer> readLayers(const std::string& file);

// A phase function from a file of its Legendre moments chi_0 = 1, chi_1 ..., parted by commas, spaces or lines. Throws
// InvalidInput naming the file and, where one is at fault, the line.
PhaseFunction readMoments(const std::string& file);

}  // namespace sunfleck::apps
