#include "render/compare/radiance_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "render/compare/detail/radial_scale.hpp"
#include "render/compare/detail/radiance_map.hpp"
#include "render/compare/detail/svg_text.hpp"

namespace sunfleck {
namespace {

constexpr double kX = 330., kY = 345., kRadius = 225.;  // centre and outermost ring of the polar panel
constexpr double kPolarWidth = 660., kMapWidth = 330., kHeight = 632.;
constexpr double kDegree = std::numbers::pi / 180.;
constexpr std::array kColours{"#1f77b4", "#d95f02", "#1b9e77", "#7b3294", "#b2182b", "#666666",
                              "#e6ab02", "#17becf", "#e377c2", "#8c564b", "#9acd32", "#000080"};
constexpr std::array kDashes{"", "7 4", "2 3", "9 3 2 3", "1 5", "12 3", "5 2 1 2 1 2"};

// Where light that travels at `angle` from the downward vertical, over azimuth 0 to the right, is drawn.
struct Place {
  double x, y;
};
Place polar(double angle, double radius) {
  return {kX + radius * std::sin(angle), kY + radius * std::cos(angle)};
}

template <typename Values>
std::size_t indexIn(Values& values, const typename Values::value_type& value) {
  const auto found = std::ranges::find(values, value);
  const auto index = static_cast<std::size_t>(found - values.begin());
  if (found == values.end()) values.push_back(value);
  return index;
}

RadialScale scaleOf(const RadiancePlot& plot) {
  double smallest = std::numeric_limits<double>::infinity(), largest = 0.;
  for (const PrincipalPlane& plane : plot.planes)
    for (const double value : plane.radiances) {
      if (value > 0.) smallest = std::min(smallest, value);
      largest = std::max(largest, value);
    }
  return radialScale(std::isfinite(smallest) ? smallest : 0., largest, plot.logarithmic);
}

std::string rings(const RadialScale& scale) {
  std::string svg;
  for (int degrees = 0; degrees < 360; degrees += 30) {
    const Place end = polar(degrees * kDegree, kRadius), name = polar(degrees * kDegree, kRadius + 17.);
    svg += fmt::format(R"(<line x1="{}" y1="{}" x2="{:.1f}" y2="{:.1f}" stroke="#e4e4e4"/>)", kX, kY, end.x, end.y);
    const int from_vertical = degrees <= 180 ? degrees : 360 - degrees;
    svg += svgText(name.x, name.y + 4., "middle", fmt::format("{}°", from_vertical), R"( fill="#777" font-size="11")");
  }
  for (const double ring : scale.rings)
    svg += fmt::format(R"(<circle cx="{}" cy="{}" r="{:.1f}" fill="none" stroke="{}"/>)", kX, kY,
                       kRadius * scale.at(ring), ring == scale.rings.back() ? "#999" : "#d4d4d4");
  // The horizontal face parts light that travels down from light that travels up.
  svg += fmt::format(R"(<line x1="{}" y1="{}" x2="{}" y2="{}" stroke="#999"/>)", kX - kRadius, kY, kX + kRadius, kY);
  return svg;
}

std::string ringLabels(const RadialScale& scale) {
  std::string svg;
  for (const double ring : scale.rings) {
    const Place place = polar(-105. * kDegree, kRadius * scale.at(ring));
    svg += svgText(place.x, place.y + 4., "middle", fmt::format("{:.4g}", ring),
                   R"( font-size="11" fill="#444" stroke="white" stroke-width="3" paint-order="stroke")");
  }
  return svg;
}

// Each hemisphere by itself: at a face of the slab radiance jumps at the horizon.
std::string curve(const PrincipalPlane& plane, const RadialScale& scale, const char* colour, const char* dash) {
  std::string path;
  bool drawing = false, was_down = false;
  for (std::size_t i = 0; i < plane.angles.size(); ++i) {
    const bool down = std::cos(plane.angles[i]) > 0.;
    const Place place = polar(plane.angles[i], kRadius * scale.at(plane.radiances[i]));
    path += fmt::format("{}{:.1f} {:.1f}", drawing && down == was_down ? "L" : "M", place.x, place.y);
    drawing = true;
    was_down = down;
  }
  return fmt::format(R"(<path d="{}" fill="none" stroke="{}" stroke-width="2" stroke-linejoin="round"{}/>)", path,
                     colour, *dash ? fmt::format(R"( stroke-dasharray="{}")", dash) : "");
}

std::string arrow(double mu0) {
  const double angle = std::acos(std::min(1., mu0));
  const Place tail = polar(angle + std::numbers::pi, kRadius + 44.), head = polar(angle + std::numbers::pi, 7.);
  const Place label = polar(angle + std::numbers::pi, kRadius + 50.);
  return fmt::format(R"svg(<line x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}" stroke="#e6a700" )svg"
                     R"svg(stroke-width="3" marker-end="url(#tip)"/>)svg",
                     tail.x, tail.y, head.x, head.y) +
         svgText(label.x, label.y - 3., "middle", "beam", R"( fill="#b58300" font-size="13")");
}

// Entries below the plot, as many to a line as fit; `bottom` is set to where they end.
std::string legend(const std::vector<PrincipalPlane>& planes, const std::vector<double>& depths,
                   const std::vector<std::string>& models, double& bottom) {
  std::string svg;
  double x = 24., y = 638.;
  const auto entry = [&](const std::string& label, const char* colour, const char* dash) {
    const double width = 52. + 7. * static_cast<double>(label.size());
    if (x + width > kPolarWidth) {
      x = 24.;
      y += 18.;
    }
    svg += fmt::format(R"(<line x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}" stroke="{}" stroke-width="2"{}/>)", x,
                       y - 4., x + 30., y - 4., colour, *dash ? fmt::format(R"( stroke-dasharray="{}")", dash) : "");
    svg += svgText(x + 36., y, "start", label);
    x += width;
  };
  for (const PrincipalPlane& plane : planes) {
    const auto depth = static_cast<std::size_t>(std::ranges::find(depths, plane.depth) - depths.begin());
    const auto model = static_cast<std::size_t>(std::ranges::find(models, plane.model) - models.begin());
    entry(fmt::format("{}, depth {:.4g}", plane.model, plane.depth), kColours[depth % kColours.size()],
          kDashes[model % kDashes.size()]);
  }
  bottom = y + 24.;
  return svg;
}

}  // namespace

std::string radiancePlot(const RadiancePlot& plot) {
  std::vector<double> depths;
  std::vector<std::string> models;
  std::string curves;
  const RadialScale scale = scaleOf(plot);
  for (const PrincipalPlane& plane : plot.planes) {
    const std::size_t depth = indexIn(depths, plane.depth), model = indexIn(models, plane.model);
    curves += curve(plane, scale, kColours[depth % kColours.size()], kDashes[model % kDashes.size()]);
  }
  const double width = kPolarWidth + (plot.map ? kMapWidth : 0.);
  double height = 0.;
  const std::string curve_legend = legend(plot.planes, depths, models, height);
  std::string svg = fmt::format(
      R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0} {1}" width="{0}" height="{1}" role="img" )"
      R"(font-family="sans-serif" font-size="12"><rect width="{0}" height="{1}" fill="white"/>)"
      R"(<defs><marker id="tip" viewBox="0 0 10 10" refX="7" refY="5" markerWidth="6" markerHeight="6" orient="auto">)"
      R"(<path d="M0 0L10 5L0 10z" fill="#e6a700"/></marker></defs>)",
      width, height);
  svg += svgText(24., 28., "start", plot.title, R"( font-size="17")");
  svg += svgText(24., 48., "start", plot.subtitle, R"( fill="#555")");
  svg += rings(scale);
  if (plot.beam_mu0) svg += arrow(*plot.beam_mu0);
  svg += curves + ringLabels(scale);
  svg += svgText(kPolarWidth - 16., kY - kRadius - 4., "end", "light that travels up", R"( fill="#777")");
  svg += svgText(kPolarWidth - 16., kY + kRadius + 12., "end", "light that travels down", R"( fill="#777")");
  svg += svgText(kX + kRadius + 32., kY - 4., "start", "azimuth 0°", R"( fill="#777" font-size="11")");
  svg += svgText(kX - kRadius - 32., kY - 4., "end", "180°", R"( fill="#777" font-size="11")");
  svg += curve_legend;
  if (plot.map)
    svg += fmt::format(R"svg(<g transform="translate({} 0)">)svg", kPolarWidth) +
           radianceMapPanel(*plot.map, plot.beam_mu0, plot.logarithmic) + "</g>";
  return svg + "</svg>\n";
}

}  // namespace sunfleck
