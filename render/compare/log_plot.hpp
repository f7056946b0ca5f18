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
  bool dashed = false;
  std::vector<LogPoint> points;
};
struct LogPanel {
  std::string title, x_title, y_title;
  std::vector<LogCurve> curves;
};
// Panels in rows of `columns`, each with its own axes over whole decades. Curves of one label share one legend entry.
std::string logPlot(const std::string& title, const std::vector<LogPanel>& panels, int columns);

}  // namespace sunfleck
