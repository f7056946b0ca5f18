#include <imgui.h>
#include <imgui_stdlib.h>

#include "apps/view/detail/widgets.hpp"
#include "apps/view/panels.hpp"

namespace sunfleck::view {

void Panels::drawFiles(Session& session, Requests& requests) {
  const auto writes = [](const char* id, std::string& path, const char* button, const char* about) {
    ImGui::PushID(id);
    ImGui::InputText("##path", &path);
    tip("File to write, from the folder in which the program was started");
    ImGui::SameLine();
    const bool pressed = ImGui::Button(button, {-1.f, 0.f});
    tip(about);
    ImGui::PopID();
    return pressed;
  };
  heading("Save");
  if (writes("png", picture_file, "picture", "The picture as shown, without panels: .png"))
    requests.screenshot = picture_file;
  if (writes("exr", exr_file, "radiances", "Radiances in layers, with depth, G and what is seen: .exr"))
    requests.exr = exr_file;
  if (writes("toml", scene_file, "scene", "The scene with its cameras, as every command reads it: .toml"))
    requests.scene = scene_file;
  heading("Cameras");
  ImGui::InputText("##name", &camera_name);
  tip("Name, 1 to 64 characters");
  ImGui::SameLine();
  if (ImGui::Button("keep", {-1.f, 0.f}))
    session.attempt([&] { session.edit(SaveCamera{{camera_name, session.camera}}); });
  tip("Keeps where you look from under this name; saved with the scene");
  std::optional<std::string> forgotten;
  for (const SavedCamera& saved : session.document().scene.saved_cameras) {
    ImGui::PushID(saved.name.c_str());
    if (ImGui::Button("go")) session.goTo(saved.name);
    tip("Look from there");
    ImGui::SameLine();
    if (ImGui::Button("forget")) forgotten = saved.name;
    tip("Take it off the list");
    ImGui::SameLine();
    ImGui::TextUnformatted(saved.name.c_str());
    ImGui::PopID();
  }
  if (forgotten) session.attempt([&] { session.edit(ForgetCamera{*forgotten}); });
  if (ImGui::Button("show the whole stand")) session.showWholeStand();
  tip("From where you look (F)");
  heading("Keys");
  ImGui::TextWrapped(
      "drag: turn; right drag: shift; wheel: nearer\nclick: select a tree; drag it: move\nL and drag: turn the sun\n"
      "space, held: flip A and B\nCtrl Z, Ctrl Y: undo, redo\nDelete: delete the tree\nF: whole stand\nTab: panels\n"
      "W A S D Q E: fly and walk\nEscape: select none");
}

}  // namespace sunfleck::view
