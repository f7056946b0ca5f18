#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "apps/view/detail/widgets.hpp"
#include "apps/view/panels.hpp"
#include "sky/preetham.hpp"

namespace sunfleck::view {
namespace {

// A disc of the sky seen from below on a map: the zenith in the middle, the horizon at its rim, +x to the right, +y up.
// Gives whether the sun was dragged.
bool skyDisc(const std::vector<Sun>& suns, std::size_t edited, float& zenith, float& azimuth) {
  const float radius = 5.5f * ImGui::GetFontSize(), below = 0.12f * radius;  // room below the horizon
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float side = 2.f * (radius + below), indent = 0.5f * std::max(0.f, ImGui::GetContentRegionAvail().x - side);
  const ImVec2 centre(corner.x + indent + 0.5f * side, corner.y + 0.5f * side);
  ImGui::SetCursorScreenPos({corner.x + indent, corner.y});
  ImGui::InvisibleButton("sky disc", {side, side});
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddCircleFilled(centre, radius + below, IM_COL32(28, 32, 34, 255), 64);
  list.AddCircleFilled(centre, radius, IM_COL32(58, 88, 122, 255), 64);
  for (const float ring : {1.f / 3.f, 2.f / 3.f})
    list.AddCircle(centre, ring * radius, IM_COL32(110, 140, 170, 120), 64);
  list.AddLine({centre.x - radius, centre.y}, {centre.x + radius, centre.y}, IM_COL32(110, 140, 170, 120));
  list.AddLine({centre.x, centre.y - radius}, {centre.x, centre.y + radius}, IM_COL32(110, 140, 170, 120));
  list.AddText({centre.x + radius - 0.9f * ImGui::GetFontSize(), centre.y}, IM_COL32(200, 215, 230, 200), "x");
  list.AddText({centre.x + 3.f, centre.y - radius}, IM_COL32(200, 215, 230, 200), "y");
  constexpr float kHorizon = 1.5707963f;
  for (std::size_t i = 0; i < suns.size(); ++i) {
    const float away = radius * std::min(suns[i].zenith / kHorizon, 1.f + below / radius);
    const ImVec2 at(centre.x + away * std::cos(suns[i].azimuth), centre.y - away * std::sin(suns[i].azimuth));
    const ImU32 colour = suns[i].up() ? IM_COL32(255, 225, 120, 255) : IM_COL32(130, 120, 100, 255);
    list.AddCircleFilled(at, i == edited ? 8.f : 5.f, colour);
    list.AddCircle(at, i == edited ? 9.f : 6.f, IM_COL32(40, 30, 0, 255));
  }
  if (!ImGui::IsItemActive()) return false;
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const glm::vec2 from(mouse.x - centre.x, centre.y - mouse.y);
  zenith = std::min(kHorizon * glm::length(from) / radius, kHorizon * (1.f + below / radius));
  if (from != glm::vec2(0.f)) azimuth = std::atan2(from.y, from.x);
  return true;
}

}  // namespace

void Panels::drawLight(Session& session) {
  drawSun(session);
  drawSky(session);
  heading("Ground");
  glm::vec3 albedo = session.document().scene.ground_albedo;
  if (changed(ImGui::ColorEdit3("albedo", &albedo.x, ImGuiColorEditFlags_Float), session))
    session.attempt([&] { session.edit(SetGround{albedo}, gesture); });
  tip("Share of light that the ground scatters, per band, 0 to 1; 0: no ground is drawn");
}

void Panels::drawSun(Session& session) {
  std::vector<Sun> suns = session.document().scene.suns;
  sun = std::min(sun, suns.size() - 1);
  heading("Sun");
  for (std::size_t i = 0; i < suns.size(); ++i) {
    if (i > 0) ImGui::SameLine();
    if (ImGui::RadioButton(fmt::format("{}", i + 1).c_str(), sun == i)) sun = i;
    tip("The sun that is changed here");
  }
  ImGui::SameLine();
  ImGui::BeginDisabled(suns.size() >= kMostSuns);
  if (ImGui::SmallButton("+")) {
    suns.push_back({.zenith = 0.8f, .azimuth = suns.back().azimuth + 1.5f, .irradiance = glm::vec3(0.5f)});
    session.attempt([&] { session.edit(SetSuns{suns}); });
    sun = suns.size() - 1;
  }
  ImGui::EndDisabled();
  tip("One more sun, 4 at most");
  ImGui::SameLine();
  ImGui::BeginDisabled(suns.size() == 1);
  if (ImGui::SmallButton("-")) {
    suns.erase(suns.begin() + static_cast<std::ptrdiff_t>(sun));
    session.attempt([&] { session.edit(SetSuns{suns}); });
    sun = 0;
  }
  ImGui::EndDisabled();
  tip("Take this sun away");
  suns = session.document().scene.suns;
  Sun& of = suns[sun];
  bool edited = false;
  edited |= changed(skyDisc(suns, sun, of.zenith, of.azimuth), session);
  tip("Drag the sun over the sky: the zenith is the middle, the horizon the rim. In the picture: hold L and drag");
  float zenith = glm::degrees(of.zenith), azimuth = glm::degrees(of.azimuth);
  if (changed(ImGui::SliderFloat("zenith", &zenith, 0.f, 100.f, "%.1f\u00b0"), session)) {
    of.zenith = glm::radians(zenith);
    edited = true;
  }
  tip("Angle from overhead [degrees]; from 89.9 on the sun has set and gives no light");
  if (changed(ImGui::SliderFloat("azimuth", &azimuth, -180.f, 180.f, "%.1f\u00b0"), session)) {
    of.azimuth = glm::radians(azimuth);
    edited = true;
  }
  tip("Where the sun stands, from +x towards +y [degrees]");
  edited |= changed(ImGui::DragFloat3("irradiance", &of.irradiance.x, 0.01f, 0.f, 10.f, "%.2f"), session);
  tip("Of a plane that faces the sun, per band, 0 to 10; all radiances are relative to 1");
  float diameter = glm::degrees(of.diameter);
  if (changed(ImGui::SliderFloat("diameter", &diameter, 0.f, 10.f, "%.2f\u00b0"), session)) {
    of.diameter = diameter < 0.25f ? 0.f : glm::radians(diameter);
    edited = true;
  }
  tip("Of the sun's disc [degrees]; 0: a point. The real one has 0.53. Monte Carlo knows it, the models take a point");
  if (edited) session.attempt([&] { session.edit(SetSuns{suns}, gesture); });

  if (ImGui::TreeNode("By date and place")) {
    ImGui::InputText("date", &date);
    tip("Year-month-day, such as 2026-06-21");
    ImGui::InputText("time", &time);
    tip("Hours:minutes, such as 12:00, in universal time, or with the offset of a zone, such as 14:00+02:00");
    ImGui::DragFloat("latitude", &latitude, 0.1f, -90.f, 90.f, "%.2f\u00b0");
    tip("Degrees, north above 0");
    ImGui::DragFloat("longitude", &longitude, 0.1f, -180.f, 180.f, "%.2f\u00b0");
    tip("Degrees, east above 0");
    if (ImGui::Button("Set the sun"))
      session.attempt([&] { session.turnSunByDate(sun, date, time, double{latitude}, double{longitude}); });
    tip("+x is east, +y is north");
    ImGui::TreePop();
  }
}

void Panels::drawSkyImage(Session& session, const SceneSky& sky) {
  ImGui::InputText("file", &sky_file);
  tip("A panorama in latitude and longitude, its zenith on top: .hdr or .exr");
  const bool read = ImGui::Button("Read the image");
  tip("In the background; the image becomes the sky");
  bool turned = false;
  if (sky.kind == SceneSky::Kind::image) {
    if (!ImGui::IsAnyItemActive()) sky_rotation = glm::degrees(sky.rotation);
    ImGui::SliderFloat("rotation", &sky_rotation, -180.f, 180.f, "%.0f\u00b0");
    turned = ImGui::IsItemDeactivatedAfterEdit();
    tip("Azimuth of the image's middle column [degrees]");
  }
  if (!read && !turned) return;
  chooses_image = false;
  session.attempt([&] { session.setSkyImage(read ? sky_file : sky.file, glm::radians(turned ? sky_rotation : 0.f)); });
}

void Panels::drawSky(Session& session) {
  using Kind = SceneSky::Kind;
  heading("Sky");
  SceneSky sky = session.document().scene.sky;
  static constexpr std::array<std::pair<Kind, const char*>, 5> kKinds{{{Kind::none, "none"},
                                                                       {Kind::uniform, "uniform"},
                                                                       {Kind::overcast, "overcast"},
                                                                       {Kind::preetham, "Preetham, clear"},
                                                                       {Kind::image, "image"}}};
  const char* name = "image";
  for (const auto& [kind_of_sky, text] : kKinds)
    if (sky.kind == kind_of_sky && !chooses_image) name = text;
  if (ImGui::BeginCombo("kind", name)) {
    for (const auto& [kind_of_sky, text] : kKinds)
      if (ImGui::Selectable(text, name == text) && name != text) {
        chooses_image = kind_of_sky == Kind::image;
        if (chooses_image) continue;  // the file must be named first
        sky = SceneSky{.kind = kind_of_sky, .turbidity = sky.turbidity};
        if (kind_of_sky == Kind::uniform || kind_of_sky == Kind::overcast) sky.irradiance = glm::dvec3(kSkyIrradiance);
        session.attempt([&] { session.edit(SetSky{sky}); });
      }
    ImGui::EndCombo();
  }
  tip("What shines beside the suns. Preetham's clear sky is lit by the first sun");
  if (chooses_image || sky.kind == Kind::image) drawSkyImage(session, sky);
  if (sky.kind == Kind::none || chooses_image) return;
  bool edited = false;
  if (sky.kind == Kind::preetham) {
    auto turbidity = static_cast<float>(sky.turbidity);
    if (changed(ImGui::SliderFloat("turbidity", &turbidity, static_cast<float>(kLeastTurbidity),
                                   static_cast<float>(kMostTurbidity), "%.1f"),
                session)) {
      sky.turbidity = std::clamp(double{turbidity}, kLeastTurbidity, kMostTurbidity);
      edited = true;
    }
    tip("Haze of the air, 1.7 to 10; 2 is clear, 6 hazy");
    edited |= changed(ImGui::Checkbox("coloured sun", &sky.coloured_sun), session);
    tip("The sun's light takes its colour behind that air");
  } else {
    glm::vec3 irradiance = sky.irradiance.value_or(glm::dvec3(kSkyIrradiance));
    if (changed(ImGui::DragFloat3("irradiance##sky", &irradiance.x, 0.005f, 0.f, 10.f, "%.3f"), session)) {
      sky.irradiance = irradiance;
      edited = true;
    }
    tip("Of a horizontal plane, per band, by the unit of the sun's");
  }
  if (edited) session.attempt([&] { session.edit(SetSky{sky}, gesture); });
}

}  // namespace sunfleck::view
