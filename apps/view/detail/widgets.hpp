#pragma once

#include <imgui.h>

#include <string>

// Small pieces of the panels.
namespace sunfleck::view {

// What the item before means, with its unit, when the mouse rests on it.
inline void tip(const char* text) {
  if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(22.f * ImGui::GetFontSize());
  ImGui::TextUnformatted(text);
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

inline void heading(const char* text) {
  ImGui::Spacing();
  ImGui::TextColored({0.62f, 0.82f, 0.58f, 1.f}, "%s", text);
  ImGui::Separator();
}

// A line of a table of two columns that has begun.
inline void row(const char* name, const std::string& value) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TextDisabled("%s", name);
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(value.c_str());
}

inline bool beginRows(const char* name) {
  return ImGui::BeginTable(name, 2, ImGuiTableFlags_SizingStretchProp);
}

}  // namespace sunfleck::view
