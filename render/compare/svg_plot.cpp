#include "render/compare/svg_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/compare/detail/svg_text.hpp"

namespace sunfleck {
namespace {

constexpr double kWidth = 560., kHeight = 320.;                           // of the picture
constexpr double kLeft = 62., kRight = 546., kTop = 34., kBottom = 272.;  // of the plotted area

// A step of 1, 2 or 5 times a power of ten that divides `range` into at most `most` parts.
double niceStep(double range, int most) {
  const double rough = range / most;
  const double power = std::pow(10., std::floor(std::log10(rough)));
  for (const double factor : {1., 2., 5.})
    if (factor * power >= rough) return factor * power;
  return 10. * power;
}

// A linear axis from 0 (or `low`) to a round number above `high`.
struct Axis {
  double low, high, step, from, to;
  double at(double value) const { return from + (value - low) / (high - low) * (to - from); }
};

Axis axisTo(double high, double from, double to, int most) {
  const double top = high > 0. && std::isfinite(high) ? high : 1.;
  const double step = niceStep(top, most);
  return {.low = 0., .high = step * std::ceil(top / step), .step = step, .from = from, .to = to};
}

std::string frame(const Axis& y, const std::string& y_title, double per_unit, const std::string& unit) {
  std::string svg = fmt::format(
      R"(<svg viewBox="0 0 {0} {1}" width="{0}" height="{1}" role="img" font-family="sans-serif" font-size="12">)",
      kWidth, kHeight);
  for (int i = 0; y.low + i * y.step <= y.high * (1. + 1e-9); ++i) {
    const double value = y.low + i * y.step;
    svg += fmt::format(R"(<line x1="{}" x2="{}" y1="{:.1f}" y2="{:.1f}" stroke="#ddd"/>)", kLeft, kRight, y.at(value),
                       y.at(value));
    svg += svgText(kLeft - 6., y.at(value) + 4., "end", fmt::format("{:g}{}", value * per_unit, unit));
  }
  svg += svgText(14., 0.5 * (kTop + kBottom), "middle", y_title,
                 fmt::format(R"svg( transform="rotate(-90 14 {:.1f})")svg", 0.5 * (kTop + kBottom)));
  return svg;
}

struct LegendEntry {
  std::string label, colour;
  bool outlined;
};

std::string legend(const std::vector<LegendEntry>& entries) {
  std::string svg;
  double x = kLeft;
  for (const LegendEntry& entry : entries) {
    svg += fmt::format(R"(<rect x="{:.1f}" y="10" width="12" height="12" fill="{}" stroke="{}" stroke-width="1.5"/>)",
                       x, entry.outlined ? "none" : entry.colour, entry.colour);
    svg += svgText(x + 17., 20.5, "start", entry.label);
    x += 36. + 7. * static_cast<double>(entry.label.size());
  }
  return svg;
}

}  // namespace

std::string escapeMarkup(const std::string& text) {
  std::string safe;
  for (const char c : text) switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\'':
        safe += "&#39;";
        break;
      default:
        safe += c;
    }
  return safe;
}

std::string linePlot(const std::string& x_title, const std::string& y_title, const std::vector<PlotLine>& lines) {
  double x_high = 0., y_high = 0.;
  for (const PlotLine& line : lines)
    for (const PlotPoint& p : line.points) {
      x_high = std::max(x_high, p.x);
      y_high = std::max(y_high, p.y + p.error);
    }
  const Axis x = axisTo(x_high, kLeft, kRight, 10), y = axisTo(y_high, kBottom, kTop, 6);
  std::string svg = frame(y, y_title, 1., "");
  for (int i = 0; x.low + i * x.step <= x.high * (1. + 1e-9); ++i)
    svg += svgText(x.at(x.low + i * x.step), kBottom + 18., "middle", fmt::format("{:g}", x.low + i * x.step));
  svg += svgText(0.5 * (kLeft + kRight), kBottom + 38., "middle", x_title);
  std::vector<LegendEntry> entries;
  for (const PlotLine& line : lines) {
    if (line.points.empty()) continue;
    entries.push_back({line.label, line.colour, false});
    std::string path, marks;
    for (const PlotPoint& p : line.points) {
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : " L", x.at(p.x), y.at(p.y));
      marks += fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="3" fill="{}"/>)", x.at(p.x), y.at(p.y), line.colour);
      if (p.error > 0.)
        marks += fmt::format(R"(<line x1="{0:.1f}" x2="{0:.1f}" y1="{1:.1f}" y2="{2:.1f}" stroke="{3}"/>)", x.at(p.x),
                             y.at(p.y - p.error), y.at(p.y + p.error), line.colour);
    }
    svg += fmt::format(R"(<path d="{}" fill="none" stroke="{}" stroke-width="2"/>)", path, line.colour) + marks;
  }
  return svg + legend(entries) + "</svg>";
}

std::string barPlot(const std::string& y_title, const std::vector<PlotBar>& bars) {
  double high = 0.;
  std::vector<std::string> groups;
  std::vector<LegendEntry> entries;
  for (const PlotBar& bar : bars) {
    high = std::max(high, bar.value);
    if (groups.empty() || groups.back() != bar.group) groups.push_back(bar.group);
    if (std::none_of(entries.begin(), entries.end(), [&](const LegendEntry& e) { return e.label == bar.label; }))
      entries.push_back({bar.label, bar.colour, bar.outlined});
  }
  const Axis y = axisTo(high, kBottom, kTop, 6);
  std::string svg = frame(y, y_title, 100., " %");
  // Bars of equal width, with a gap of one bar between groups.
  const double slot = (kRight - kLeft) / static_cast<double>(bars.size() + groups.size());
  double x = kLeft + 0.5 * slot, group_start = x;
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const PlotBar& bar = bars[i];
    svg += fmt::format(
        R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" fill="{}" stroke="{}" stroke-width="1.5"/>)",
        x + 0.08 * slot, y.at(bar.value), 0.84 * slot, kBottom - y.at(bar.value), bar.outlined ? "none" : bar.colour,
        bar.colour);
    svg += svgText(x + 0.5 * slot, y.at(bar.value) - 4., "middle", fmt::format("{:.3g}", 100. * bar.value),
                   R"( font-size="11")");
    x += slot;
    if (i + 1 == bars.size() || bars[i + 1].group != bar.group) {
      const std::size_t comma = bar.group.find(", ");
      svg += svgText(0.5 * (group_start + x), kBottom + 18., "middle", bar.group.substr(0, comma));
      if (comma != std::string::npos)
        svg += svgText(0.5 * (group_start + x), kBottom + 33., "middle", bar.group.substr(comma + 2),
                       R"( font-size="11")");
      group_start = x += slot;
    }
  }
  return svg + legend(entries) + "</svg>";
}

}  // namespace sunfleck
