#pragma once

#include <optional>
#include <string>
#include <vector>

namespace sunfleck {

// Radiance at one depth of a slab, by one model, in the principal plane: of light that travels at `angles` [rad], from
// the downward vertical (0) over azimuth 0 (pi / 2) to the upward vertical (pi) and back over azimuth 180 degrees to 2
// pi.
struct PrincipalPlane {
  std::string model;
  double depth = 0.;              // [1]
  std::vector<double> angles;     // [rad], rising
  std::vector<double> radiances;  // [1/sr per irradiance 1], as many
};

// Radiance at one depth over both hemispheres of travel: values[(h * zeniths + i) * azimuths + j], h = 0 downward, 1
// upward; zenith angle of travel i / (zeniths - 1) * 90 degrees from the vertical; azimuth j / (azimuths - 1) * 180
// degrees, the other half of the circle being its mirror image.
struct RadianceMap {
  std::string model;
  double depth = 0.;
  int zeniths = 0, azimuths = 0;
  std::vector<double> values;
};

struct RadiancePlot {
  std::string title, subtitle;
  std::vector<PrincipalPlane> planes;
  std::optional<double> beam_mu0;  // a beam of azimuth 0, drawn as an arrow
  std::optional<RadianceMap> map;  // a second panel
  bool logarithmic = false;        // radius and colour; else from 0
};

// A polar plot as SVG text, like Figs. 2 and 3 of Shinya et al. 2013: the distance of a curve from the centre is the
// radiance of the light that travels that way. Each depth has its colour, each model its kind of line.
std::string radiancePlot(const RadiancePlot& plot);

}  // namespace sunfleck
