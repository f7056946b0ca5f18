#pragma once

#include <string>
#include <vector>

namespace sunfleck {

// Plots as SVG text that stands inside an HTML page.

struct PlotPoint {
  double x = 0., y = 0.;
  double error = 0.;  // half length of a bar through the point; 0: none
};
struct PlotLine {
  std::string label, colour;
  std::vector<PlotPoint> points;
};
// Lines with markers from y = 0 up. Empty lines are left out.
std::string linePlot(const std::string& x_title, const std::string& y_title, const std::vector<PlotLine>& lines);

struct PlotBar {
  std::string group;  // the bars of a group stand together over its name, which breaks after a comma
  std::string label, colour;
  double value = 0.;
  bool outlined = false;  // outline instead of a filled bar
};
// Bars with their values written above; values are fractions, shown in percent.
std::string barPlot(const std::string& y_title, const std::vector<PlotBar>& bars);

// The text with &, <, > and quotes made safe for HTML and SVG.
std::string escapeMarkup(const std::string& text);

}  // namespace sunfleck
