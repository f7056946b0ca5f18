#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace sunfleck {

struct SpectrumCurve {
  std::string label, colour;
  bool joined = true;                             // else a dot for each point
  std::vector<std::pair<double, double>> points;  // wavelength [nm], share [1]
};
// A colour as an eye sees it, beside its name.
struct ColourSwatch {
  std::string label;
  std::array<double, 3> linear_rgb;  // [1], 0 .. 1
};

// Shares of light over wavelength, from 0 to 1, as SVG text.
std::string spectrumPlot(const std::string& title, const std::string& subtitle,
                         const std::vector<SpectrumCurve>& curves, const std::vector<ColourSwatch>& swatches);

}  // namespace sunfleck
