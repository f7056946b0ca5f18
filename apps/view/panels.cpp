#include "apps/view/panels.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>

#include "apps/view/detail/widgets.hpp"

namespace sunfleck::view {
namespace {

constexpr float kPanelWidth = 21.f, kStatusHeight = 1.9f;  // in heights of a letter
// Narrower windows show all panels at their left, or none at all [heights of a letter].
constexpr float kBothSides = 80.f, kOneSide = 40.f;

// What takes a moment is told; what is done at once does not flicker [s].
constexpr double kMoment = 0.15;

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                                    ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoSavedSettings |
                                    ImGuiWindowFlags_NoBringToFrontOnFocus;

bool leftTab(Tab tab) {
  return tab <= Tab::model;
}

}  // namespace

glm::vec3 differenceColour(float difference) {
  const float size = std::min(std::abs(difference), 1.f), faint = std::sqrt(size);
  return difference < 0.f ? glm::vec3(0.1f * size, 0.35f * size, faint) : glm::vec3(faint, 0.3f * size, 0.1f * size);
}

const char* nameOf(Tab tab) {
  static constexpr std::array kNames{"Scene", "Light", "Leaf", "Model", "Compare", "Probe", "Times", "Files"};
  return kNames[static_cast<std::size_t>(tab)];
}

void Panels::show(Tab tab) {
  (leftTab(tab) ? left : right) = tab;
  (leftTab(tab) ? choose_left : choose_right) = true;
}

bool Panels::changed(bool changed, Session& session) {
  if (ImGui::IsItemActivated()) gesture = session.newGesture();
  return changed;
}

std::pair<glm::ivec2, glm::ivec2> Panels::draw(glm::ivec2 window, Session& session, const FrameReport& report,
                                               Requests& requests) {
  if (!shown) return {glm::ivec2(0), glm::max(window, glm::ivec2(1))};
  const float letter = ImGui::GetFontSize();
  const float status = std::round(kStatusHeight * letter), height = static_cast<float>(window.y) - status;
  const auto width_in_letters = static_cast<float>(window.x) / letter;
  const float panel = std::round(kPanelWidth * letter);
  int from = 0, to = window.x;
  const auto draw_side = [&](const char* name, ImVec2 corner, float high, bool is_left) {
    ImGui::SetNextWindowPos(corner);
    ImGui::SetNextWindowSize({panel, std::max(high, 1.f)});
    if (ImGui::Begin(name, nullptr, kFixed) && ImGui::BeginTabBar("tabs")) {
      bool& choose = is_left ? choose_left : choose_right;
      Tab& active = is_left ? left : right;
      const Tab wanted = active;
      for (const Tab tab : kTabs) {
        if (leftTab(tab) != is_left) continue;
        const bool bring = choose && tab == wanted;
        if (ImGui::BeginTabItem(nameOf(tab), nullptr, bring ? ImGuiTabItemFlags_SetSelected : 0)) {
          if (!choose) active = tab;
          if (ImGui::BeginChild(nameOf(tab))) drawTab(tab, session, report, requests);
          ImGui::EndChild();
          ImGui::EndTabItem();
        }
      }
      choose = false;
      ImGui::EndTabBar();
    }
    ImGui::End();
  };
  const bool both_sides = width_in_letters >= kBothSides;
  if (session.loaded() && width_in_letters > kOneSide && height > 0.f) {
    const float left_height = both_sides ? height : std::round(0.55f * height);
    draw_side("left", {0.f, 0.f}, left_height, true);
    from = static_cast<int>(panel);
    if (both_sides) to = window.x - static_cast<int>(panel);
    draw_side("right", both_sides ? ImVec2(static_cast<float>(to), 0.f) : ImVec2(0.f, left_height),
              both_sides ? height : height - left_height, false);
  }
  drawStatus(window, status, session, report, requests);
  return {glm::ivec2(from, 0), glm::max(glm::ivec2(to - from, static_cast<int>(height)), glm::ivec2(1))};
}

void Panels::drawTab(Tab tab, Session& session, const FrameReport& report, Requests& requests) {
  ImGui::PushItemWidth(-9.5f * ImGui::GetFontSize());
  switch (tab) {
    case Tab::scene:
      drawScene(session);
      break;
    case Tab::light:
      drawLight(session);
      break;
    case Tab::leaf:
      drawLeaf(session);
      break;
    case Tab::model:
      drawModel(session);
      break;
    case Tab::compare:
      drawCompare(session, report);
      break;
    case Tab::probe:
      drawProbe(session, report);
      break;
    case Tab::times:
      drawTimes(session, report);
      break;
    case Tab::files:
      drawFiles(session, requests);
      break;
  }
  ImGui::PopItemWidth();
}

void Panels::drawStatus(glm::ivec2 window, float height, Session& session, const FrameReport& report,
                        Requests& requests) {
  ImGui::SetNextWindowPos({0.f, static_cast<float>(window.y) - height});
  ImGui::SetNextWindowSize({static_cast<float>(window.x), height});
  ImGui::PushStyleColor(ImGuiCol_WindowBg, ImVec4(0.07f, 0.08f, 0.075f, 1.f));
  if (ImGui::Begin("status", nullptr, kFixed | ImGuiWindowFlags_NoScrollbar)) {
    StandWorker::State work = session.work();
    if (report.exr_done) {
      work = {.busy = true, .done = *report.exr_done, .what = "drawing an EXR", .seconds = kMoment + 1.};
    } else if (const auto writes = session.writes(); writes && !work.busy) {
      work = {.busy = true, .done = 1., .what = *writes, .seconds = kMoment + 1.};
    }
    if (work.busy && work.seconds > kMoment) {
      ImGui::AlignTextToFramePadding();
      ImGui::TextUnformatted(work.what.c_str());
      ImGui::SameLine();
      const std::string share =
          work.done > 0. ? fmt::format("{:.0f} %", 100. * work.done) : fmt::format("{:.1f} s", work.seconds);
      ImGui::ProgressBar(static_cast<float>(work.done), {10.f * ImGui::GetFontSize(), 0.f}, share.c_str());
      ImGui::SameLine();
      if (session.loaded() && ImGui::SmallButton("cancel")) requests.cancel = true;
      tip("Ends it; what is drawn stays as it is");
      ImGui::SameLine();
    }
    if (session.messageIsError())
      ImGui::TextColored({1.f, 0.55f, 0.4f, 1.f}, "%s", session.message().c_str());
    else
      ImGui::TextUnformatted(session.message().c_str());
    if (session.loaded() && !report.frame_ms.empty()) {
      const std::string told = fmt::format("{}   {} of {} samples   {:.0f} ms a frame",
                                           session.document().model == Model::field && !session.fieldText().empty()
                                               ? session.fieldText()
                                               : nameOf(session.document().model),
                                           report.samples, session.look.samples, report.frame_ms.back());
      ImGui::SameLine(ImGui::GetWindowWidth() - ImGui::CalcTextSize(told.c_str()).x - ImGui::GetFontSize());
      ImGui::TextDisabled("%s", told.c_str());
    }
  }
  ImGui::End();
  ImGui::PopStyleColor();
}

}  // namespace sunfleck::view
