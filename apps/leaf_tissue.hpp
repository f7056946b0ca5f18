#pragma once

#include <string>

namespace sunfleck::apps {

// What a slab of tissue does to light, told as absorption=..,scattering=..,thickness=.. in 1/mm and mm; as text or
// JSON. Throws InvalidInput naming --tissue.
std::string tissueReport(const std::string& tissue, bool json);

// The tissue behind reflectance=..,transmittance=..,thickness=.. (0.2 mm if not told), in the same form. Throws
// InvalidInput naming --sides.
std::string sidesReport(const std::string& sides, bool json);

}  // namespace sunfleck::apps
