#pragma once

#include <filesystem>
#include <string>

#include "core/progress.hpp"
#include "render/compare/slab_models.hpp"

namespace sunfleck::apps {

// Solves the slabs of a CSV file with the header g,omega,thickness,mu0, as many lines as there may be, and writes each
// line back in its place with reflectance,transmittance,direct: to `output`, whole or not at all, or to stdout once all
// lines are right. On all threads; the result is the same for any number of them. Throws InvalidInput naming file, line
// and field of the first line that is wrong.
//   settings  of the exact solver
// Returns false, with nothing written, when `progress` has ended it.
bool solveBatch(const std::string& cases, const SlabModel& model, const pp::Settings& settings,
                const std::filesystem::path& output, const Progress& progress);

}  // namespace sunfleck::apps
