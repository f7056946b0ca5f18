#pragma once

#include <string>
#include <utility>
#include <vector>

#include "leaves/leaf_contents.hpp"
#include "leaves/leaf_description.hpp"
#include "leaves/leaf_spectrum.hpp"
#include "leaves/light_bands.hpp"

namespace sunfleck::apps {

// "chlorophyll=40,water=0.01" as names and numbers. Throws InvalidInput("<option>: ...") on any other text.
std::vector<std::pair<std::string, double>> namedNumbers(const std::string& text, const std::string& option);

// The contents of a leaf by its species, which may be empty, and by what --prospect or the like tells. Throws
// InvalidInput.
LeafContents leafContentsOf(const std::string& species, const std::string& prospect, const std::string& species_option,
                            const std::string& prospect_option);

// "620:680,550,400:2500:50" as bands: from and to, one wavelength, or from, to and the width of each. Throws
// InvalidInput("<option>: ...") on any other text.
std::vector<WavelengthBand> bandsOf(const std::string& text, const std::string& option);

// What tells the optics of a scene's leaves by what they are.
struct LeafOptions {
  std::string species, prospect, bands;
  bool given() const { return !species.empty() || !prospect.empty(); }
};
// What they tell. Both throw InvalidInput, naming the option, on what is wrong.
LeafByContents leafOf(const LeafOptions& options);
LightBands lightBandsOf(const LeafOptions& options);

}  // namespace sunfleck::apps
