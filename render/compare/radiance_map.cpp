#include "render/compare/detail/radiance_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/image.hpp"
#include "render/compare/base64.hpp"
#include "render/compare/detail/radial_scale.hpp"
#include "render/compare/detail/svg_text.hpp"
#include "render/false_colour.hpp"
#include "render/image_file.hpp"
#include "render/tone_mapping.hpp"

namespace sunfleck {
namespace {

constexpr double kDisc = 108., kX = 140.;     // radius and centre of the discs
constexpr double kUpY = 205., kDownY = 460.;  // of their centres: light that travels up is above
constexpr int kPixels = 320;                  // sides of a disc's picture
constexpr double kBarLeft = 278., kBarTop = 97., kBarBottom = 568., kBarWidth = 12.;

// Straight lines between the grid's values.
double valueAt(const RadianceMap& map, int hemisphere, double zenith_share, double azimuth_share) {
  const double i = std::clamp(zenith_share, 0., 1.) * (map.zeniths - 1);
  const double j = std::clamp(azimuth_share, 0., 1.) * (map.azimuths - 1);
  const int i0 = std::min(static_cast<int>(i), map.zeniths - 2), j0 = std::min(static_cast<int>(j), map.azimuths - 2);
  const auto value = [&](int a, int b) {
    return map.values[static_cast<std::size_t>((hemisphere * map.zeniths + a) * map.azimuths + b)];
  };
  const double di = i - i0, dj = j - j0;
  return (1. - di) * ((1. - dj) * value(i0, j0) + dj * value(i0, j0 + 1)) +
         di * ((1. - dj) * value(i0 + 1, j0) + dj * value(i0 + 1, j0 + 1));
}

std::string picture(const RadianceMap& map, int hemisphere, const RadialScale& scale) {
  Image image{.width = kPixels, .height = kPixels, .channels = {"R", "G", "B"}, .values = {}};
  for (int y = 0; y < kPixels; ++y)
    for (int x = 0; x < kPixels; ++x) {
      const double right = 2. * (x + 0.5) / kPixels - 1., up = 1. - 2. * (y + 0.5) / kPixels;
      const double azimuth = std::abs(std::atan2(up, right)) / std::numbers::pi;
      const glm::vec3 code =
          falseColour(static_cast<float>(scale.at(valueAt(map, hemisphere, std::hypot(right, up), azimuth))));
      for (int band = 0; band < 3; ++band) image.values.push_back(tone_mapping::srgbLight(code[band]));
    }
  return "data:image/png;base64," + base64(pngBytes(image, 1.f));
}

std::string disc(const RadianceMap& map, int hemisphere, const RadialScale& scale, double y, const char* name) {
  std::string svg =
      fmt::format(R"svg(<clipPath id="disc{0}"><circle cx="{1}" cy="{2}" r="{3}"/></clipPath>)svg"
                  R"svg(<image x="{4}" y="{5}" width="{6}" height="{6}" clip-path="url(#disc{0})" href="{7}"/>)svg",
                  hemisphere, kX, y, kDisc, kX - kDisc, y - kDisc, 2. * kDisc, picture(map, hemisphere, scale));
  for (const double share : {1. / 3., 2. / 3., 1.})
    svg += fmt::format(R"(<circle cx="{}" cy="{}" r="{:.1f}" fill="none" stroke="{}" stroke-width="{}"/>)", kX, y,
                       share * kDisc, share < 1. ? "#ffffff66" : "#777", share < 1. ? 0.8 : 1.);
  return svg + svgText(kX, y + kDisc + 16., "middle", name, R"( fill="#555")");
}

std::string colourBar(const RadialScale& scale) {
  std::string svg = R"(<linearGradient id="ramp" x1="0" x2="0" y1="1" y2="0">)";
  for (int i = 0; i <= 16; ++i) {
    const glm::vec3 colour = 255.f * falseColour(static_cast<float>(i) / 16.f);
    svg += fmt::format(R"svg(<stop offset="{}" stop-color="rgb({:.0f},{:.0f},{:.0f})"/>)svg", i / 16., colour.x,
                       colour.y, colour.z);
  }
  svg += fmt::format(R"svg(</linearGradient><rect x="{}" y="{}" width="{}" height="{}" fill="url(#ramp)"/>)svg",
                     kBarLeft, kBarTop, kBarWidth, kBarBottom - kBarTop);
  std::vector<double> values = scale.rings;
  values.insert(values.begin(), scale.logarithmic ? scale.low : 0.);
  for (const double value : values)
    svg += svgText(kBarLeft + kBarWidth + 4., kBarBottom - scale.at(value) * (kBarBottom - kBarTop) + 4., "start",
                   fmt::format("{:.3g}", value), R"( font-size="11")");
  return svg + svgText(kBarLeft + kBarWidth, kBarTop - 14., "middle", "1/sr", R"( font-size="11" fill="#555")");
}

}  // namespace

std::string radianceMapPanel(const RadianceMap& map, const std::optional<double>& beam_mu0, bool logarithmic) {
  double smallest = std::numeric_limits<double>::infinity(), largest = 0.;
  for (const double value : map.values) {
    if (value > 0.) smallest = std::min(smallest, value);
    largest = std::max(largest, value);
  }
  const RadialScale scale = radialScale(std::isfinite(smallest) ? smallest : 0., largest, logarithmic);
  std::string svg = svgText(kX, 76., "middle", fmt::format("{}, depth {:.4g}: all directions", map.model, map.depth));
  svg += disc(map, 1, scale, kUpY, "travels up; azimuth 0° to the right");
  svg += disc(map, 0, scale, kDownY, "travels down; rings 30°, 60°, 90°");
  if (beam_mu0) {  // where the beam's own light goes
    const double x = kX + kDisc * std::acos(std::min(1., *beam_mu0)) / (0.5 * std::numbers::pi);
    svg +=
        fmt::format(R"(<circle cx="{:.1f}" cy="{}" r="5" fill="none" stroke="#d62728" stroke-width="2"/>)", x, kDownY);
  }
  return svg + colourBar(scale);
}

}  // namespace sunfleck
