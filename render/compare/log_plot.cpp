#include "render/compare/log_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <ranges>

#include "render/compare/detail/svg_text.hpp"

namespace sunfleck {
namespace {

constexpr double kPanelWidth = 660., kPanelHeight = 520.;
constexpr double kLeft = 74., kRight = 640., kTop = 40., kBottom = 460.;  // of the plotted area within its panel
constexpr double kHeader = 48.;                                           // title and what stays free below
constexpr double kRadius = 4., kMarkSize = 12., kLegendLine = 18., kSubtitleLine = 18.;

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

// Powers of ten from 1e-12 to 1 second, as "100 ns".
std::string secondsText(double x, double y, int power) {
  static constexpr std::array kUnits{"ps", "ns", "us", "ms", "s"};
  const int unit = (power + 12) / 3;
  if (power < -12 || unit >= static_cast<int>(kUnits.size())) return powerOfTen(x, y, "middle", power);
  return svgText(x, y, "middle",
                 fmt::format("{:g} {}", std::pow(10., (power + 12) % 3), kUnits[static_cast<std::size_t>(unit)]));
}

std::string grid(const LogAxis& x, const LogAxis& y, bool x_seconds) {
  std::string svg;
  const int step = std::max(1, (y.high - y.low + 7) / 8);  // at most eight labels
  for (int power = x.low; power <= x.high; ++power) {
    const double at = x.at(std::pow(10., power));
    for (int digit = 2; digit < 10 && power < x.high; ++digit) {
      const double fine = x.at(digit * std::pow(10., power));
      svg += line(fine, kTop, fine, kBottom, "#f4f4f4");
    }
    svg += line(at, kTop, at, kBottom, "#d8d8d8");
    svg += x_seconds ? secondsText(at, kBottom + 20., power) : powerOfTen(at, kBottom + 20., "middle", power);
  }
  for (int power = y.low; power <= y.high; ++power) {
    const double at = y.at(std::pow(10., power));
    svg += line(kLeft, at, kRight, at, (power - y.low) % step == 0 ? "#d8d8d8" : "#f4f4f4");
    if ((power - y.low) % step == 0) svg += powerOfTen(kLeft - 8., at + 4., "end", power);
  }
  return svg;
}

// What no mark may cover.
struct Box {
  double left, top, right, bottom;
  // By how much two overlap, as an area.
  double common(const Box& other) const {
    return std::max(0., std::min(right, other.right) - std::max(left, other.left)) *
           std::max(0., std::min(bottom, other.bottom) - std::max(top, other.top));
  }
};

class Marks {
 public:
  explicit Marks(Box legend) : taken_{legend} {}

  void take(const Box& box) { taken_.push_back(box); }

  // Writes a mark beside a point where it covers least: to its right, its left, above or below.
  std::string beside(double x, double y, const std::string& mark, const std::string& colour) {
    const double width = 0.56 * kMarkSize * static_cast<double>(mark.size()), gap = kRadius + 3.;
    double least = std::numeric_limits<double>::infinity();
    Box best{};
    for (const auto& [dx, dy] : {std::pair{1., 0.},
                                 {1., -0.8},
                                 {1., 0.8},
                                 {-1., 0.},
                                 {-1., -0.8},
                                 {-1., 0.8},
                                 {0., -1.2},
                                 {0., 1.2},
                                 {1., -1.8},
                                 {1., 1.8},
                                 {-1., -1.8},
                                 {-1., 1.8}}) {
      const double middle_y = y + dy * (kMarkSize + 2.);
      const double left = dx > 0. ? x + gap : dx < 0. ? x - gap - width : x - 0.5 * width;
      const Box box{left, middle_y - 0.5 * kMarkSize, left + width, middle_y + 0.5 * kMarkSize};
      double covered = 0.;
      for (const Box& other : taken_) covered += box.common(other);
      const double outside = width * kMarkSize - box.common({kLeft + 2., kTop + 2., kRight - 2., kBottom - 2.});
      if (covered + outside < least - 1e-9) {
        least = covered + outside;
        best = box;
      }
    }
    take(best);
    return svgText(best.left, best.bottom - 2., "start", mark,
                   fmt::format(R"( font-size="{}" fill="{}")", kMarkSize, colour));
  }

 private:
  std::vector<Box> taken_;
};

std::string joined(const LogCurve& curve, const LogAxis& x, const LogAxis& y) {
  std::string path;
  for (const LogPoint& p : curve.points)
    if (drawable(p)) path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : " L", x.at(p.x), y.at(p.y));
  if (path.empty() || !curve.joined) return {};
  return fmt::format(R"(<path d="{}" fill="none" stroke="{}" stroke-width="1.8" stroke-opacity="0.7"/>)", path,
                     curve.colour);
}

std::string dot(double x, double y, const std::string& colour) {
  return fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="{}" fill="{}" stroke="white"/>)", x, y, kRadius, colour);
}

std::string legend(const LogPanel& panel, const Box& place) {
  std::string svg;
  double y = place.top + 0.5 * kLegendLine;
  for (const LogCurve& curve : panel.curves) {
    if (curve.joined)
      svg += fmt::format(R"(<path d="M{:.1f} {:.1f} h24" stroke="{}" stroke-width="1.8"/>)", place.left + 6., y,
                         curve.colour);
    svg += fmt::format(R"(<path d="M{:.1f} {:.1f} h0.01" stroke="{}" stroke-width="8" stroke-linecap="round"/>)",
                       place.left + 18., y, curve.colour) +
           svgText(place.left + 36., y + 4., "start", curve.label, fmt::format(R"( fill="{}")", curve.colour));
    y += kLegendLine;
  }
  return svg;
}

std::string drawn(const LogPanel& panel) {
  const LogAxis x = axisOver(panel, &LogPoint::x, kLeft, kRight);
  LogAxis y = axisOver(panel, &LogPoint::y, kBottom, kTop);
  if (panel.rising) --y.low;
  std::size_t longest = 0;
  for (const LogCurve& curve : panel.curves) longest = std::max(longest, curve.label.size());
  const Box key{kLeft + 6., kBottom - 8. - kLegendLine * static_cast<double>(panel.curves.size()),
                kLeft + 46. + 6.2 * static_cast<double>(longest), kBottom - 8.};
  std::string svg =
      svgText(0.5 * (kLeft + kRight), kTop - 12., "middle", panel.title, R"( font-weight="bold" font-size="14")") +
      grid(x, y, panel.x_seconds);
  svg += fmt::format(R"(<rect x="{}" y="{}" width="{}" height="{}" fill="none" stroke="#888"/>)", kLeft, kTop,
                     kRight - kLeft, kBottom - kTop);
  Marks marks(key);
  std::string dots, texts;
  for (const LogCurve& curve : panel.curves) {
    svg += joined(curve, x, y);
    for (const LogPoint& p : curve.points) {
      if (!drawable(p)) continue;
      const double at_x = x.at(p.x), at_y = y.at(p.y);
      dots += dot(at_x, at_y, curve.colour);
      marks.take({at_x - kRadius, at_y - kRadius, at_x + kRadius, at_y + kRadius});
    }
  }
  for (const LogCurve& curve : panel.curves)
    for (const LogPoint& p : curve.points)
      if (drawable(p) && !p.mark.empty()) texts += marks.beside(x.at(p.x), y.at(p.y), p.mark, curve.colour);
  svg += legend(panel, key) + dots + texts;
  svg += svgText(0.5 * (kLeft + kRight), kBottom + 42., "middle", panel.x_title);
  return svg + svgText(20., 0.5 * (kTop + kBottom), "middle", panel.y_title,
                       fmt::format(R"svg( transform="rotate(-90 20 {:.1f})")svg", 0.5 * (kTop + kBottom)));
}

}  // namespace

std::string logPlot(const std::string& title, const std::string& subtitle, const std::vector<LogPanel>& panels,
                    int columns) {
  const auto lines = static_cast<double>(1 + std::ranges::count(subtitle, '\n'));
  const double header = kHeader + lines * kSubtitleLine;
  const int rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
  const double width = columns * kPanelWidth, height = header + rows * kPanelHeight;
  std::string svg = fmt::format(
      R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0} {1}" width="{0}" height="{1}" role="img" )"
      R"(font-family="sans-serif" font-size="12"><rect width="{0}" height="{1}" fill="white"/>)",
      width, height);
  svg += svgText(kLeft, 28., "start", title, R"( font-size="18")");
  double y = 50.;
  for (const auto line : std::views::split(subtitle, '\n')) {
    svg += svgText(kLeft, y, "start", std::string(line.begin(), line.end()), R"( fill="#555")");
    y += kSubtitleLine;
  }
  for (std::size_t i = 0; i < panels.size(); ++i)
    svg += fmt::format(R"svg(<g transform="translate({} {})">)svg",
                       static_cast<double>(i % static_cast<std::size_t>(columns)) * kPanelWidth,
                       header + static_cast<double>(i / static_cast<std::size_t>(columns)) * kPanelHeight) +
           drawn(panels[i]) + "</g>";
  return svg + "</svg>\n";
}

}  // namespace sunfleck
