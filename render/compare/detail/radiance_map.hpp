#pragma once

#include <optional>
#include <string>

#include "render/compare/radiance_plot.hpp"

namespace sunfleck {

// The discs of both hemispheres with their scale of colours, as SVG text 330 wide and 640 high. The distance from a
// disc's centre is the angle from the vertical; azimuth 0 is to the right.
std::string radianceMapPanel(const RadianceMap& map, const std::optional<double>& beam_mu0, bool logarithmic);

}  // namespace sunfleck
