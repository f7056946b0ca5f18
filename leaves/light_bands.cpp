#include "leaves/light_bands.hpp"

#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <vector>

#include "leaves/detail/data_texts.hpp"
#include "leaves/detail/number_table.hpp"

namespace sunfleck {
namespace {

struct ColourWeight {
  double wavelength = 0.;  // [nm]
  glm::dvec3 rgb{0.};      // summed over all wavelengths 1, 1, 1
};

glm::dvec3 fromChromaticity(double x, double y) {
  return {x / y, 1., (1. - x - y) / y};
}

// Weights of reflectance in each colour. The white of sRGB is that of the table, or a white leaf would have a hue.
std::vector<ColourWeight> colourWeights() {
  constexpr std::size_t kColumns = 5;
  const std::vector<double> table = detail::numberTable(detail::dataText("cie_1931_d65.txt"));
  std::vector<ColourWeight> weights;
  glm::dvec3 white(0.);
  for (std::size_t row = 0; row < table.size(); row += kColumns) {
    const double* value = &table[row];
    weights.push_back({value[0], value[4] * glm::dvec3(value[1], value[2], value[3])});
    white += weights.back().rgb;
  }
  glm::dmat3 primaries(fromChromaticity(0.64, 0.33), fromChromaticity(0.30, 0.60), fromChromaticity(0.15, 0.06));
  const glm::dmat3 from_xyz = glm::inverse(primaries);
  const glm::dvec3 of_white = from_xyz * white;
  for (ColourWeight& weight : weights) weight.rgb = (from_xyz * weight.rgb) / of_white;
  return weights;
}

}  // namespace

std::array<LeafSides, kBands> rgbOf(const LeafSpectrum& spectrum) {
  static const std::vector<ColourWeight> weights = colourWeights();
  glm::dvec3 reflectance(0.), transmittance(0.);
  for (const ColourWeight& weight : weights) {
    const double wavelength = std::max(weight.wavelength, double{kFirstWavelength});
    const LeafSides sides = meanIn(spectrum, {wavelength, wavelength});
    reflectance += sides.reflectance * weight.rgb;
    transmittance += sides.transmittance * weight.rgb;
  }
  std::array<LeafSides, kBands> rgb;
  for (int band = 0; band < kBands; ++band) {
    const double r = std::clamp(reflectance[band], 0., 1.), t = std::clamp(transmittance[band], 0., 1.);
    const double all = std::max(r + t, 1.);
    rgb[static_cast<std::size_t>(band)] = {.reflectance = r / all, .transmittance = std::min(t / all, 1. - r / all)};
  }
  return rgb;
}

LeafOptics leafOptics(const LeafSides& sides) {
  LeafOptics optics{.reflectance = static_cast<float>(sides.reflectance),
                    .transmittance = static_cast<float>(sides.transmittance)};
  while (optics.albedo() > 1.f) optics.transmittance = std::nextafter(optics.transmittance, 0.f);
  return optics;
}

BandOptics bandOptics(const LeafSpectrum& spectrum, const LightBands& bands) {
  const std::array<LeafSides, kBands> rgb = bands ? std::array<LeafSides, kBands>{} : rgbOf(spectrum);
  BandOptics optics;
  for (std::size_t band = 0; band < kBands; ++band)
    optics[band] = leafOptics(bands ? meanIn(spectrum, (*bands)[band]) : rgb[band]);
  return optics;
}

}  // namespace sunfleck
