#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/progress.hpp"
#include "render/compare/slab_choice.hpp"

namespace sunfleck::apps {

// Solves slabs side by side. The results stand in the order of the cases; a result's model is empty where none was
// chosen.
using SolveCases = std::function<std::vector<ChosenFluxes>(std::span<const pp::SlabCase>)>;

// Solves the slabs of a CSV file with the header g,omega,thickness,mu0, as many lines as there may be, and writes each
// line back in its place with reflectance,transmittance,direct, and with the model if `names_models`: to `output`,
// whole or not at all, or to stdout once all lines are right. On all threads, `solve` at once for several parts of the
// file. Throws InvalidInput naming file, line and field of the first line that is wrong. Returns false, with nothing
// written, when `progress` has ended it.
bool solveBatch(const std::string& cases, const SolveCases& solve, bool names_models,
                const std::filesystem::path& output, const Progress& progress);

}  // namespace sunfleck::apps
