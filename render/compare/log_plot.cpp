#include "render/compare/log_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/compare/detail/svg_text.hpp"

namespace sunfleck {
namespace {

constexpr double kPanelWidth = 520., kPanelHeight = 380.;
constexpr double kLeft = 74., kRight = 500., kTop = 40., kBottom = 320.;  // of the plotted area within its panel
constexpr double kHeader = 66.;                                           // title and legend

// An axis over whole decades.
struct LogAxis {
  int low, high;  // powers of ten
  double from, to;
  double at(double value) const { return from + (std::log10(value) - low) / (high - low) * (to - from); }
};

bool drawable(const LogPoint& p) {
  return p.x > 0. && p.y > 0. && std::isfinite(p.x) && std::isfinite(p.y);
}

LogAxis axisOver(const LogPanel& panel, double LogPoint::*coordinate, double from, double to) {
  double low = std::numeric_limits<double>::infinity(), high = 0.;
  for (const LogCurve& curve : panel.curves)
    for (const LogPoint& p : curve.points)
      if (drawable(p)) {
        low = std::min(low, p.*coordinate);
        high = std::max(high, p.*coordinate);
      }
  if (high == 0.) low = high = 1.;
  LogAxis axis{.low = static_cast<int>(std::floor(std::log10(low))),
               .high = static_cast<int>(std::ceil(std::log10(high))),
               .from = from,
               .to = to};
  if (axis.high <= axis.low) axis.high = axis.low + 1;
  return axis;
}

std::string line(double x1, double y1, double x2, double y2, const char* colour) {
  return fmt::format(R"(<line x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}" stroke="{}"/>)", x1, y1, x2, y2, colour);
}

std::string powerOfTen(double x, double y, const std::string& anchor, int power) {
  return fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="{}">10<tspan dy="-5" font-size="9">{}</tspan></text>)",
                     x, y, anchor, power);
}

std::string grid(const LogAxis& x, const LogAxis& y) {
  std::string svg;
  const int step = std::max(1, (y.high - y.low + 7) / 8);  // at most eight labels
  for (int power = x.low; power <= x.high; ++power) {
    const double at = x.at(std::pow(10., power));
    for (int digit = 2; digit < 10 && power < x.high; ++digit) {
      const double fine = x.at(digit * std::pow(10., power));
      svg += line(fine, kTop, fine, kBottom, "#f2f2f2");
    }
    svg += line(at, kTop, at, kBottom, "#d8d8d8") + powerOfTen(at, kBottom + 20., "middle", power);
  }
  for (int power = y.low; power <= y.high; ++power) {
    const double at = y.at(std::pow(10., power));
    svg += line(kLeft, at, kRight, at, (power - y.low) % step == 0 ? "#d8d8d8" : "#f2f2f2");
    if ((power - y.low) % step == 0) svg += powerOfTen(kLeft - 8., at + 4., "end", power);
  }
  return svg;
}

std::string drawn(const LogCurve& curve, const LogAxis& x, const LogAxis& y) {
  std::string path, marks;
  for (const LogPoint& p : curve.points) {
    if (!drawable(p)) continue;
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : " L", x.at(p.x), y.at(p.y));
    marks += fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="3.2" fill="{}" stroke="{}" stroke-width="1.5"/>)",
                         x.at(p.x), y.at(p.y), curve.dashed ? "white" : curve.colour, curve.colour);
    if (!p.mark.empty())
      marks += svgText(x.at(p.x) + 6., y.at(p.y) - 5., "start", p.mark,
                       fmt::format(R"( font-size="10" fill="{}")", curve.colour));
  }
  if (path.empty()) return {};
  return fmt::format(R"(<path d="{}" fill="none" stroke="{}" stroke-width="1.8"{}/>)", path, curve.colour,
                     curve.dashed ? R"( stroke-dasharray="6 4")" : "") +
         marks;
}

std::string drawn(const LogPanel& panel) {
  const LogAxis x = axisOver(panel, &LogPoint::x, kLeft, kRight), y = axisOver(panel, &LogPoint::y, kBottom, kTop);
  std::string svg = svgText(0.5 * (kLeft + kRight), kTop - 12., "middle", panel.title, R"( font-weight="bold")");
  svg += grid(x, y);
  svg += fmt::format(R"(<rect x="{}" y="{}" width="{}" height="{}" fill="none" stroke="#888"/>)", kLeft, kTop,
                     kRight - kLeft, kBottom - kTop);
  for (const LogCurve& curve : panel.curves) svg += drawn(curve, x, y);
  svg += svgText(0.5 * (kLeft + kRight), kBottom + 42., "middle", panel.x_title);
  return svg + svgText(20., 0.5 * (kTop + kBottom), "middle", panel.y_title,
                       fmt::format(R"svg( transform="rotate(-90 20 {:.1f})")svg", 0.5 * (kTop + kBottom)));
}

std::string legend(const std::vector<LogPanel>& panels) {
  std::vector<LogCurve> entries;
  for (const LogPanel& panel : panels)
    for (const LogCurve& curve : panel.curves)
      if (std::ranges::find(entries, curve.label, &LogCurve::label) == entries.end()) entries.push_back(curve);
  std::string svg;
  double x = kLeft;
  for (const LogCurve& entry : entries) {
    svg += fmt::format(R"(<line x1="{:.1f}" y1="46" x2="{:.1f}" y2="46" stroke="{}" stroke-width="2"{}/>)", x, x + 28.,
                       entry.colour, entry.dashed ? R"( stroke-dasharray="6 4")" : "");
    svg += svgText(x + 34., 50., "start", entry.label);
    x += 58. + 6.6 * static_cast<double>(entry.label.size());
  }
  return svg;
}

}  // namespace

std::string logPlot(const std::string& title, const std::vector<LogPanel>& panels, int columns) {
  const int rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
  const double width = columns * kPanelWidth, height = kHeader + rows * kPanelHeight;
  std::string svg = fmt::format(
      R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0} {1}" width="{0}" height="{1}" role="img" )"
      R"(font-family="sans-serif" font-size="12"><rect width="{0}" height="{1}" fill="white"/>)",
      width, height);
  svg += svgText(kLeft, 24., "start", title, R"( font-size="16")") + legend(panels);
  for (std::size_t i = 0; i < panels.size(); ++i)
    svg += fmt::format(R"svg(<g transform="translate({} {})">)svg",
                       static_cast<double>(i % static_cast<std::size_t>(columns)) * kPanelWidth,
                       kHeader + static_cast<double>(i / static_cast<std::size_t>(columns)) * kPanelHeight) +
           drawn(panels[i]) + "</g>";
  return svg + "</svg>\n";
}

}  // namespace sunfleck
