#include <fmt/format.h>
#include <imgui.h>

#include "apps/view/detail/widgets.hpp"
#include "apps/view/panels.hpp"

namespace sunfleck::view {
namespace {

// Blue where B is brighter, red where A is, with the numbers at its ends.
void colourBar(float scale) {
  const float width = ImGui::GetContentRegionAvail().x, height = ImGui::GetFontSize();
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  constexpr int kSteps = 64;
  for (int i = 0; i < kSteps; ++i) {
    const glm::vec3 c = differenceColour(2.f * (static_cast<float>(i) + 0.5f) / kSteps - 1.f);
    ImGui::GetWindowDrawList()->AddRectFilled(
        {corner.x + width * static_cast<float>(i) / kSteps, corner.y},
        {corner.x + width * static_cast<float>(i + 1) / kSteps, corner.y + height},
        ImGui::ColorConvertFloat4ToU32({c.x, c.y, c.z, 1.f}));
  }
  ImGui::Dummy({width, height});
  tip("A - B: radiance [1/sr], mean of the bands");
  ImGui::Text("%.3g", double{-scale});
  ImGui::SameLine(0.5f * width);
  ImGui::TextUnformatted("0");
  const std::string high = fmt::format("{:.3g}", scale);
  ImGui::SameLine(width - ImGui::CalcTextSize(high.c_str()).x);
  ImGui::TextUnformatted(high.c_str());
}

std::string shareText(double share) {
  return fmt::format("{:.2f} %", 100. * share);
}

}  // namespace

void Panels::drawCompare(Session& session, const FrameReport& report) {
  Look& look = session.look;
  ImGui::TextWrapped("A is %s.", nameOf(session.document().model).c_str());
  heading("B");
  if (ImGui::BeginTable("models", 3)) {
    for (const Model model : kModels) {
      ImGui::TableNextColumn();
      if (ImGui::RadioButton(nameOf(model).c_str(), look.other == model)) look.other = model;
      tip(aboutOf(model));
    }
    ImGui::EndTable();
  }
  if (ImGui::RadioButton("Monte Carlo", !look.other)) look.other.reset();
  tip("The reference: computed in the background for this very picture, and refined while you look");
  heading("Shown");
  const auto choose = [&](const char* name, Comparison of, const char* about) {
    if (ImGui::RadioButton(name, look.comparison == of)) look.comparison = of;
    tip(about);
  };
  choose("A alone", Comparison::off, "Hold the space bar to flip to B");
  choose("wipe", Comparison::wipe, "A to the left, B to the right of a line that you can drag");
  choose("B alone", Comparison::flip, "Hold the space bar to flip to A");
  choose("difference", Comparison::difference, "A - B in false colours");
  if (look.comparison == Comparison::wipe) {
    ImGui::SliderFloat("line", &look.wipe, 0.f, 1.f, "%.2f");
    tip("Share of the width that shows A");
  }
  if (look.comparison == Comparison::difference) {
    bool own = look.difference_scale == 0.f;
    if (ImGui::Checkbox("scale of the picture", &own)) look.difference_scale = own ? 0.f : report.difference_scale;
    tip("The last colour is that of the largest differences, but for half a percent of the pixels");
    if (!own) {
      ImGui::DragFloat("scale", &look.difference_scale, 0.001f, 1e-5f, 100.f, "%.4f", ImGuiSliderFlags_Logarithmic);
      tip("Difference that has the last colour [1/sr]");
    }
    colourBar(report.difference_scale);
  }
  if (look.comparison == Comparison::off) return;
  heading("Error");
  if (!report.error) {
    ImGui::TextDisabled("waits for both pictures");
  } else if (beginRows("error")) {
    const PictureError& error = *report.error;
    row("relative RMS", shareText(error.rms));
    tip("Root mean square of A - B over pixels and bands, by that of B, where there is something to be seen");
    if (!look.other) {
      row("noise alone", shareText(error.noise));
      tip("What of it is Monte Carlo's noise");
      row("without noise",
          fmt::format("{} \u00b1 {}", shareText(error.without_noise), shareText(error.standard_error)));
      tip("The model's own error, with its standard error");
    }
    row("bias", fmt::format("{:+.2f} %", 100. * error.bias));
    tip("Of the sum of all light");
    ImGui::EndTable();
  }
  if (look.other) return;
  heading("Monte Carlo");
  if (!report.reference_failure.empty()) {
    ImGui::TextWrapped("%s", report.reference_failure.c_str());
    return;
  }
  if (beginRows("reference")) {
    row("noise", report.reference_noise > 0. ? shareText(report.reference_noise) : "-");
    row("time", fmt::format("{:.1f} s{}", report.reference_seconds, report.reference_runs ? ", runs" : ""));
    ImGui::EndTable();
  }
  ImGui::ProgressBar(static_cast<float>(report.reference_done), {-1.f, 0.f});
  tip("Monte Carlo begins anew when the camera or the scene changes");
}

void Panels::drawProbe(Session&, const FrameReport& report) {
  if (!report.probe) {
    ImGui::TextDisabled("Rest the mouse on the picture.");
    return;
  }
  const Probe& probe = *report.probe;
  if (!beginRows("probe")) return;
  row("pixel", fmt::format("{}, {}", probe.pixel.x, probe.pixel.y));
  row("seen", probe.what);
  if (probe.tree) row("tree", fmt::format("{}", *probe.tree + 1));
  if (probe.place)
    row("place", fmt::format("{:.2f}, {:.2f}, {:.2f} m", probe.place->x, probe.place->y, probe.place->z));
  const auto radiance = [](const glm::vec3& r) { return fmt::format("{:.4f} {:.4f} {:.4f}", r.x, r.y, r.z); };
  row("radiance", radiance(probe.radiance));
  tip("Red, green, blue [1/sr], for sun irradiance 1");
  row("order 1", radiance(probe.direct));
  tip("Light scattered once, at what is seen");
  row("order 2", radiance(probe.single));
  tip("Light that was scattered once before; 0 where the model does not tell it apart");
  row("further", radiance(probe.multiple));
  tip("All other light");
  const auto number = [](const std::optional<float>& value) { return value ? fmt::format("{:.3f}", *value) : "-"; };
  row("sky", radiance(probe.sky));
  tip("Light of the sky, scattered or seen behind all");
  row("depth", number(probe.depth));
  tip("Leaves between here and the light, along the light");
  row("thickness", number(probe.thickness));
  tip("All leaves along that line, with this one");
  row("G", number(probe.compensation));
  tip("Compensation for the crown's edge, 0 to 1");
  ImGui::EndTable();
}

void Panels::drawTimes(Session& session, const FrameReport& report) {
  heading("Frame");
  float slowest = 1.f;
  for (const float ms : report.frame_ms) slowest = std::max(slowest, ms);
  const std::string now = report.frame_ms.empty() ? "" : fmt::format("{:.0f} ms", report.frame_ms.back());
  ImGui::PlotLines("##frames", report.frame_ms.data(), static_cast<int>(report.frame_ms.size()), 0, now.c_str(), 0.f,
                   slowest, {ImGui::GetContentRegionAvail().x, 5.f * ImGui::GetFontSize()});
  tip("Time of the last frames [ms], from 0 to the slowest");
  if (beginRows("passes")) {
    for (const auto& [name, ms] : report.passes_ms) row(name.c_str(), fmt::format("{:.2f} ms", ms));
    row("to the graphics card",
        fmt::format("{:.1f} ms, {:.2f} MB", report.sent_ms, 1e-6 * static_cast<double>(report.sent_bytes)));
    ImGui::EndTable();
  }
  ImGui::TextDisabled("%s", report.renderer.c_str());
  heading("Computed anew by the last change");
  if (beginRows("cost")) {
    row("time", fmt::format("{:.1f} ms", 1e3 * session.lastSeconds()));
    tip("In the background, by the clock");
    const double all = session.preparedSeconds();
    row("of preparing all",
        all > 0. ? fmt::format("{:.1f} % of {:.0f} ms", 100. * session.lastSeconds() / all, 1e3 * all) : "-");
    tip("Of the time in which the whole stand was prepared, when its scene was read or the quality changed");
    ImGui::EndTable();
  }
  if (ImGui::BeginTable("products", 4, ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_RowBg)) {
    for (const char* column : {"product", "made", "adjusted", "ms"}) ImGui::TableSetupColumn(column);
    ImGui::TableHeadersRow();
    for (const ProductCost& cost : session.lastCosts()) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      const bool anew = cost.made + cost.adjusted > 0;
      if (anew)
        ImGui::TextUnformatted(cost.name.c_str());
      else
        ImGui::TextDisabled("%s", cost.name.c_str());
      for (const std::string& text : {fmt::format("{}", cost.made), fmt::format("{}", cost.adjusted),
                                      fmt::format("{:.1f}", 1e3 * cost.seconds)}) {
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(anew ? text.c_str() : "-");
      }
    }
    ImGui::EndTable();
  }
  tip("Members of each product of the stand that were made or adjusted; moving the camera makes none");
}

}  // namespace sunfleck::view
