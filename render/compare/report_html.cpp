#include "render/compare/report_html.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>

#include "render/compare/base64.hpp"
#include "render/compare/paper_table.hpp"
#include "render/compare/svg_plot.hpp"

namespace sunfleck {
namespace {

constexpr const char* kStyle = R"(<style>
body{font-family:sans-serif;color:#222;max-width:1180px;margin:2em auto;padding:0 1em;line-height:1.45}
h1{margin-bottom:.1em}table{border-collapse:collapse;margin:1em 0}td,th{padding:.25em .8em;text-align:right;border-bottom:1px solid #ddd}
td{white-space:nowrap}td:nth-child(-n+2),th:nth-child(-n+2){text-align:left}.side{display:flex;flex-wrap:wrap;gap:1.2em}figure{margin:0}
figcaption{font-size:.9em;color:#555;max-width:560px}img+figcaption{max-width:272px}img{max-width:100%;background:#000}code{background:#f2f2f2;padding:.1em .3em}
</style>)";

std::string colourOf(Model model) {  // Okabe & Ito's palette, safe for the colour-blind
  switch (model) {
    case Model::ss:
      return "#0072B2";
    case Model::spp:
      return "#D55E00";
    case Model::sppg:
      return "#009E73";
    case Model::sppr:
      return "#E69F00";
    case Model::nstreamg:
      return "#CC79A7";
    case Model::pp:
      return "#56B4E9";
    case Model::field:
      return "#000000";
  }
  return "#000000";
}

std::string percent(const std::optional<double>& fraction) {
  return fraction ? fmt::format("{:.3g} %", 100. * *fraction) : "-";
}

std::string errorTable(std::span<const Validation> validations) {
  std::string html =
      "<table><tr><th>scene</th><th>model</th><th>RMS by category</th><th>paper's Table 3</th><th>weighted by "
      "leaves</th><th>per leaf</th><th>total light</th><th>prepare</th><th>shade</th></tr>\n";
  for (const Validation& v : validations) {
    for (const ModelResult& m : v.models) {
      const std::optional<double> paper = paperError(v, m.model);
      html += fmt::format(
          "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{:.0f} "
          "ms</td><td>{:.2f} ms</td></tr>\n",
          kindOf(v.scene), labelOf(m.model), percent(m.errors.rms_category), percent(paper),
          percent(m.errors.rms_weighted), percent(m.errors.rms_leaf), percent(m.errors.bias), 1e3 * m.prepare_seconds,
          1e3 * m.shade_seconds);
    }
    html += fmt::format(
        "<tr><td>{}</td><td>noise of Monte "
        "Carlo</td><td></td><td></td><td>{}</td><td>{}</td><td></td><td></td><td>{:.1f} s</td></tr>\n",
        kindOf(v.scene), percent(v.category_noise), percent(v.reference_noise), v.reference.seconds);
  }
  return html + "</table>\n";
}

std::string errorPlot(std::span<const Validation> validations) {
  std::vector<PlotBar> bars;
  for (const Validation& v : validations)
    for (const ModelResult& m : v.models) {
      const std::string group = labelOf(m.model) + ", " + kindOf(v.scene);
      bars.push_back({group, "ours", "#009E73", m.errors.rms_category.value_or(0.), false});
      if (const std::optional<double> paper = paperError(v, m.model))
        bars.push_back({group, "paper, its own tree", "#555555", *paper, true});
    }
  return barPlot("RMS by category", bars);
}

// Mean irradiance of the leaves whose depth rounds to the same integer, at least 5 of them.
std::string depthPlot(const Validation& v) {
  std::map<int, std::vector<std::size_t>> by_depth;
  for (std::size_t leaf = 0; leaf < v.depths.depth.size(); ++leaf)
    by_depth[static_cast<int>(std::lround(v.depths.depth[leaf]))].push_back(leaf);
  std::vector<PlotLine> lines{{"Monte Carlo", "#000000", {}}};
  for (const ModelResult& m : v.models) lines.push_back({labelOf(m.model), colourOf(m.model), {}});
  for (const auto& [depth, leaves] : by_depth) {
    if (leaves.size() < 5) continue;
    const auto n = static_cast<double>(leaves.size());
    double reference = 0., variance = 0.;
    for (const std::size_t leaf : leaves) {
      reference += v.reference.leaf_irradiance[leaf];
      variance += v.reference.leaf_standard_error[leaf] * v.reference.leaf_standard_error[leaf];
    }
    lines[0].points.push_back({static_cast<double>(depth), reference / n, std::sqrt(variance) / n});
    for (std::size_t i = 0; i < v.models.size(); ++i) {
      double sum = 0.;
      for (const std::size_t leaf : leaves) sum += double{v.models[i].irradiance[leaf]};
      lines[i + 1].points.push_back({static_cast<double>(depth), sum / n, 0.});
    }
  }
  return fmt::format(
      "<figure>{}<figcaption>Irradiance of a leaf, both sides, against its depth: {}. Bars on Monte Carlo are its "
      "standard error.</figcaption></figure>\n",
      linePlot("depth: leaves between the light and the leaf", "irradiance / sun's", lines), kindOf(v.scene));
}

std::string facts(const Validation& v) {
  return fmt::format(
      "<p>{}: {} leaves ({} triangles, {:.4g} m² of one side), leaf albedo {:.3g}, sun {:.3g}° from the zenith. "
      "On average the sun's rays cross {:.2f} leaves before a leaf, of {:.2f} on their whole way; {} depth-thickness "
      "categories hold at least 5 leaves and "
      "leave out "
      "{} leaves. Reference: {:.3g} million paths of light, seed {}{}.</p>\n",
      escapeMarkup(kindOf(v.scene) + " (" + sourceOf(v.scene) + ")"), v.leaves, v.leaf_triangles, v.leaf_area,
      v.albedo(), v.scene.sun().zenith * 180.f / std::numbers::pi_v<float>, v.mean_depth, v.mean_thickness,
      v.categories.size(), v.leaves_left_out, static_cast<double>(v.reference.paths) * 1e-6, v.effort.trace.seed,
      v.effort.with_wood ? ", wood included" : ", leaves only");
}

}  // namespace

std::string reportHtml(std::span<const Validation> validations, std::span<const ReportPicture> pictures,
                       const ReportOrigin& origin) {
  std::string html = "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><title>Sunfleck: " +
                     escapeMarkup(validations.front().scene.name) + "</title>" + kStyle + "</head><body>\n";
  html += "<h1>" + escapeMarkup(validations.front().scene.name) + "</h1>\n";
  html += "<p>How well each scattering model predicts the light on the leaves, judged by Monte Carlo.</p>\n";
  for (const Validation& v : validations) html += facts(v);
  html += "<h2>Errors</h2>\n<div class=\"side\"><figure>" + errorPlot(validations) +
          "<figcaption>RMS error by depth-thickness category (Shinya et al. 2013, Eq. 30). The paper's tree is another "
          "cherry: its "
          "figures stand beside ours for orientation.</figcaption></figure></div>\n";
  html += errorTable(validations);
  html +=
      "<p>RMS by category weighs every depth-thickness category alike; weighted by leaves, each by its number of "
      "leaves; per leaf "
      "holds the noise of Monte Carlo too. Total light is the error of the sum over all leaves. Prepare is done once "
      "per "
      "placement of trees and sun, without the maps that a scene before has left; shade once per change of leaf "
      "optics.</p>\n";
  html += "<h2>Light inside the crown</h2>\n<div class=\"side\">";
  for (const Validation& v : validations) html += depthPlot(v);
  html += "</div>\n";
  if (!pictures.empty()) {
    html += "<h2>Pictures</h2>\n<div class=\"side\">";
    for (const ReportPicture& picture : pictures)
      html += "<figure><img alt=\"" + escapeMarkup(picture.caption) + "\" width=\"272\" src=\"data:image/png;base64," +
              base64(picture.png) + "\"><figcaption>" + escapeMarkup(picture.caption) + "</figcaption></figure>\n";
    html +=
        "</div>\n<p>All at the same exposure, with the wood and a ground that reflects a sixth of the light. Monte "
        "Carlo's ground has no end.</p>\n";
  }
  html += "<h2>Made by</h2>\n<p><code>" + escapeMarkup(origin.command) + "</code><br>Sunfleck " +
          escapeMarkup(origin.version) + ", commit " + escapeMarkup(origin.commit) + "</p>\n</body></html>\n";
  return html;
}

}  // namespace sunfleck
