#pragma once

#include <string>
#include <vector>

#include "render/reference/forward_trace.hpp"
#include "render/scene.hpp"

namespace sunfleck::apps {

// Bands of light by their names.
struct Spectrum {
  std::vector<std::string> names;
  std::vector<TraceLight> bands;
};

// Reads a CSV file name,leaf_reflectance,leaf_transmittance[,wood_reflectance[,ground_albedo]], a row for each band:
// the optics of all kinds of trees. What it does not tell is that of the scene in `band`. Throws InvalidInput naming
// file, line and column, and on a scene with leaf maps, which know no other bands than the scene's.
Spectrum readSpectrum(const std::string& file, const Scene& scene, int band);

// CSV of the shares of the light of each band and their standard errors.
void writeSpectrum(const std::string& file, const std::vector<std::string>& names,
                   const std::vector<ForwardResult>& results);

}  // namespace sunfleck::apps
