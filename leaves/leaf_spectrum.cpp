#include "leaves/leaf_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/require.hpp"

namespace sunfleck {
namespace {

LeafSides at(const LeafSpectrum& spectrum, double wavelength) {
  const double from_first = wavelength - kFirstWavelength;
  const std::size_t below = std::min(static_cast<std::size_t>(from_first), spectrum.sides.size() - 2);
  const double share = from_first - static_cast<double>(below);
  const LeafSides &low = spectrum.sides[below], &high = spectrum.sides[below + 1];
  return {.reflectance = std::lerp(low.reflectance, high.reflectance, share),
          .transmittance = std::lerp(low.transmittance, high.transmittance, share)};
}

}  // namespace

void validate(const WavelengthBand& band, const char* where) {
  const std::string rule = "in [400, 2500] nm";
  for (const double limit : {band.low, band.high})
    require(limit >= kFirstWavelength && limit <= kLastWavelength, where, limit, rule);
  require(band.low <= band.high, where, band.high, "at least the band's lower limit");
}

LeafSides meanIn(const LeafSpectrum& spectrum, const WavelengthBand& band) {
  validate(band);
  if (band.low == band.high) return at(spectrum, band.low);
  LeafSides sum, from = at(spectrum, band.low);
  for (double start = band.low; start < band.high;) {
    const double end = std::min(std::floor(start) + 1., band.high);
    const LeafSides to = at(spectrum, end);
    sum.reflectance += 0.5 * (end - start) * (from.reflectance + to.reflectance);
    sum.transmittance += 0.5 * (end - start) * (from.transmittance + to.transmittance);
    start = end;
    from = to;
  }
  const double width = band.high - band.low;
  const double reflectance = std::clamp(sum.reflectance / width, 0., 1.);
  return {.reflectance = reflectance, .transmittance = std::clamp(sum.transmittance / width, 0., 1. - reflectance)};
}

}  // namespace sunfleck
