#pragma once

#include <string>

namespace sunfleck::apps {

// Maps of one leaf as measured, and where to write what is behind them.
struct LeafMapFiles {
  std::string upper_reflectance, lower_reflectance, transmittance;  // images; the second may be empty
  double thickness = 0.2;                                           // [mm]
  std::string output;  // NAME.png or NAME.exr: NAME_upper.png, NAME_lower.png and the scene NAME.toml
};

// Finds tissue and textures (L12), writes them, and tells of it in text or JSON. Throws InvalidInput.
std::string fitMapsReport(const LeafMapFiles& files, bool json);

}  // namespace sunfleck::apps
