#pragma once

#include <string>
#include <vector>

namespace sunfleck {

// Plots with two logarithmic axes, as SVG text.

struct LogPoint {
  double x = 0., y = 0.;  // above 0; others are left out
  std::string mark;       // written beside the point; may be empty
};
struct LogCurve {
  std::string label, colour;
  bool joined = true;  // its points by a line
  std::vector<LogPoint> points;
};
struct LogPanel {
  std::string title, x_title, y_title;
  bool x_seconds = false;  // x told in ns, us, ms and s
  bool rising = false;     // points rise to the right: a decade below them is left to the legend
  std::vector<LogCurve> curves;
};
// Panels in rows of `columns`, each with its own axes over whole decades and its own legend, which stands at the lower
// left: free where points fall from the upper left to the lower right. Marks give way to points and to each other. The
// subtitle may have several lines.
std::string logPlot(const std::string& title, const std::string& subtitle, const std::vector<LogPanel>& panels,
                    int columns);

}  // namespace sunfleck
