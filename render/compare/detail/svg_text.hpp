#pragma once

#include <fmt/format.h>

#include <string>

#include "render/compare/svg_plot.hpp"

namespace sunfleck {

// A text element; `more` are further attributes, each with a space before it.
inline std::string svgText(double x, double y, const std::string& anchor, const std::string& content,
                           const std::string& more = "") {
  return fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="{}"{}>{}</text>)", x, y, anchor, more,
                     escapeMarkup(content));
}

}  // namespace sunfleck
