#include "render/compare/spectrum_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/compare/detail/svg_text.hpp"

namespace sunfleck {
namespace {

constexpr double kWidth = 860., kHeight = 500.;                           // of the picture
constexpr double kLeft = 62., kRight = 836., kTop = 84., kBottom = 430.;  // of the plotted area
constexpr double kFirst = 400., kLast = 2500.;                            // [nm]
constexpr double kTick = 100.;                                            // between lines [nm]

double across(double wavelength) {
  return kLeft + (wavelength - kFirst) / (kLast - kFirst) * (kRight - kLeft);
}
double up(double share) {
  return kBottom - std::clamp(share, -0.02, 1.02) * (kBottom - kTop);
}

int byteOf(double linear) {
  const double c = std::clamp(linear, 0., 1.);
  const double shown = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1. / 2.4) - 0.055;
  return static_cast<int>(std::lround(255. * shown));
}

std::string axes() {
  std::string svg;
  for (int tenth = 0; tenth <= 10; tenth += 2) {
    const double y = up(0.1 * tenth);
    svg += fmt::format(R"(<line x1="{}" x2="{}" y1="{:.1f}" y2="{:.1f}" stroke="#ddd"/>)", kLeft, kRight, y, y);
    svg += svgText(kLeft - 7., y + 4., "end", fmt::format("{:g}", 0.1 * tenth));
  }
  for (double nm = kFirst; nm <= kLast; nm += kTick) {
    const bool named = std::fmod(nm - kFirst, 3. * kTick) == 0.;
    svg += fmt::format(R"(<line x1="{0:.1f}" x2="{0:.1f}" y1="{1}" y2="{2}" stroke="{3}"/>)", across(nm), kTop, kBottom,
                       named ? "#ddd" : "#f2f2f2");
    if (named) svg += svgText(across(nm), kBottom + 18., "middle", fmt::format("{:g}", nm));
  }
  svg += svgText(0.5 * (kLeft + kRight), kBottom + 38., "middle", "wavelength [nm]");
  return svg + svgText(16., 0.5 * (kTop + kBottom), "middle", "share of the light that arrives",
                       fmt::format(R"svg( transform="rotate(-90 16 {:.1f})")svg", 0.5 * (kTop + kBottom)));
}

std::string drawn(const SpectrumCurve& curve) {
  std::string path, dots;
  for (const auto& [wavelength, share] : curve.points) {
    if (curve.joined)
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", across(wavelength), up(share));
    else
      dots += fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="2" fill="{}" fill-opacity="0.5"/>)", across(wavelength),
                          up(share), curve.colour);
  }
  if (!curve.joined) return dots;
  return fmt::format(R"(<path d="{}" fill="none" stroke="{}" stroke-width="1.8" stroke-linejoin="round"/>)", path,
                     curve.colour);
}

}  // namespace

std::string spectrumPlot(const std::string& title, const std::string& subtitle,
                         const std::vector<SpectrumCurve>& curves, const std::vector<ColourSwatch>& swatches) {
  std::string svg = fmt::format(
      R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0} {1}" width="{0}" height="{1}" role="img" )"
      R"(font-family="sans-serif" font-size="12"><rect width="{0}" height="{1}" fill="white"/>)",
      kWidth, kHeight);
  svg += svgText(24., 28., "start", title, R"( font-size="17")");
  svg += svgText(24., 48., "start", subtitle, R"( fill="#555")");
  svg += axes();
  double x = kLeft;
  for (const SpectrumCurve& curve : curves) {
    svg += drawn(curve);
    svg += fmt::format(R"(<rect x="{:.1f}" y="61" width="14" height="{}" fill="{}"/>)", x, curve.joined ? 3 : 8,
                       curve.colour);
    svg += svgText(x + 20., 69., "start", curve.label);
    x += 44. + 6.6 * static_cast<double>(curve.label.size());
  }
  x = kLeft;
  for (const ColourSwatch& swatch : swatches) {
    const auto& [red, green, blue] = swatch.linear_rgb;
    svg += fmt::format(R"(<rect x="{:.1f}" y="{}" width="40" height="14" fill="#{:02x}{:02x}{:02x}" stroke="#999"/>)",
                       x, kHeight - 23., byteOf(red), byteOf(green), byteOf(blue));
    svg += svgText(x + 47., kHeight - 12., "start", swatch.label);
    x += 70. + 6.6 * static_cast<double>(swatch.label.size());
  }
  return svg + "</svg>\n";
}

}  // namespace sunfleck
