#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <cmath>
#include <glm/trigonometric.hpp>

#include "apps/view/detail/widgets.hpp"
#include "apps/view/panels.hpp"
#include "plants/species.hpp"

namespace sunfleck::view {

void Panels::drawScene(Session& session) {
  const Scene& scene = session.document().scene;
  ImGui::TextWrapped("%s", scene.name.c_str());
  const auto undoes = session.history().undoes(), redoes = session.history().redoes();
  ImGui::BeginDisabled(!undoes);
  if (ImGui::Button("Undo")) session.undo();
  ImGui::EndDisabled();
  tip(undoes ? fmt::format("Undo: {} (Ctrl Z)", *undoes).c_str() : "There is nothing to undo (Ctrl Z)");
  ImGui::SameLine();
  ImGui::BeginDisabled(!redoes);
  if (ImGui::Button("Redo")) session.redo();
  ImGui::EndDisabled();
  tip(redoes ? fmt::format("Redo: {} (Ctrl Y)", *redoes).c_str() : "There is nothing to do again (Ctrl Y)");

  heading("Kinds of trees");
  if (ImGui::BeginTable("kinds", 4, ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_RowBg)) {
    for (const char* column : {"name", "trees", "leaves", "area m\u00b2"}) ImGui::TableSetupColumn(column);
    ImGui::TableHeadersRow();
    for (std::uint32_t i = 0; i < scene.kinds.size(); ++i) {
      const TreeKind& of = scene.kinds[i];
      ImGui::PushID(static_cast<int>(i));
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      if (ImGui::Selectable(of.name.c_str(), i == kind, ImGuiSelectableFlags_SpanAllColumns)) kind = i;
      tip(of.source.c_str());
      const auto trees = std::ranges::count(scene.stand.trees, i, &Placement::kind);
      ImGui::TableNextColumn();
      ImGui::Text("%td", trees);
      ImGui::TableNextColumn();
      ImGui::Text("%u", of.mesh->leaf_count);
      ImGui::TableNextColumn();
      ImGui::Text("%.1f", leafArea(*of.mesh));
      ImGui::PopID();
    }
    ImGui::EndTable();
  }
  if (kind >= scene.kinds.size()) kind = 0;
  if (ImGui::TreeNode("One more kind")) {
    if (ImGui::BeginCombo("species", new_kind.c_str())) {
      for (const std::string& name : speciesNames())
        if (ImGui::Selectable(name.c_str(), name == new_kind)) new_kind = name;
      ImGui::EndCombo();
    }
    tip("That is grown by rules");
    ImGui::InputText("or a file", &new_kind);
    tip("A tree's file: .obj or .ply, in metres");
    ImGui::InputInt("seed", &new_seed);
    tip("Of the random numbers by which a species grows");
    if (ImGui::Button("Grow or read"))
      session.attempt([&] { session.addKind(new_kind, static_cast<std::uint64_t>(std::max(new_seed, 1))); });
    tip("In the background; a tree of it is set beside the others, towards +x");
    ImGui::TreePop();
  }
  drawTrees(session);
}

void Panels::drawTrees(Session& session) {
  const Scene& scene = session.document().scene;
  heading("Click in the picture");
  const auto choose = [&](const char* name, Tool of, const char* about) {
    if (ImGui::RadioButton(name, tool == of)) tool = of;
    tip(about);
  };
  choose("select, move", Tool::select, "Click a tree to select it, then drag it on the ground");
  ImGui::SameLine();
  choose("add", Tool::add, "Click the ground to add a tree of the kind chosen above");
  ImGui::SameLine();
  choose("paint", Tool::paint, "Drag over the ground to fill it with trees of the kind chosen above");
  if (tool == Tool::paint) {
    ImGui::SliderFloat("radius", &paint_radius, 0.5f, 50.f, "%.1f m", ImGuiSliderFlags_Logarithmic);
    tip("Of the brush [m]");
    ImGui::SliderFloat("spacing", &paint_spacing, 0.3f, 30.f, "%.1f m", ImGuiSliderFlags_Logarithmic);
    tip("No tree stands nearer to another than this [m]");
  }

  heading(scene.stand.trees.empty()       ? "no tree"
          : scene.stand.trees.size() == 1 ? "1 tree"
                                          : fmt::format("{} trees", scene.stand.trees.size()).c_str());
  if (const auto selected = session.document().selected) {
    const Placement& tree = scene.stand.trees[*selected];
    ImGui::Text("tree %zu, %s", *selected + 1, scene.kindOf(tree).name.c_str());
    glm::vec3 place = tree.position;
    if (changed(ImGui::DragFloat2("x, y", &place.x, 0.02f, -1e6f, 1e6f, "%.2f m"), session))
      session.attempt([&] { session.edit(MoveTree{*selected, place}, gesture); });
    tip("Where it stands [m]; drag, or double-click to type");
    // Trees turned alike share their maps, so that it goes by steps.
    constexpr int kStep = 15;
    int steps = static_cast<int>(std::lround(glm::degrees(tree.rotation) / kStep));
    const std::string degrees = fmt::format("{}\u00b0", kStep * steps);
    if (changed(ImGui::SliderInt("rotation", &steps, -180 / kStep, 180 / kStep, degrees.c_str()), session))
      session.attempt([&] {
        session.edit(TurnTree{*selected, glm::radians(static_cast<float>(kStep * steps))}, gesture);
      });
    tip("About its stem, counter-clockwise from above [degrees]. Each direction has maps of its own, at most 64 in "
        "all");
    const float beside = 1.02f * leafBounds(*scene.kindOf(tree).mesh).size().x;
    if (ImGui::Button("Copy")) session.attempt([&] { session.copySelected({beside, 0.f}); });
    tip("A tree of the same kind beside it, towards +x");
    ImGui::SameLine();
    if (ImGui::Button("Delete")) session.attempt([&] { session.removeSelected(); });
    tip("Delete this tree (Delete)");
  } else {
    ImGui::TextDisabled("none is selected");
  }
  constexpr float kLeastLines = 6.f;
  const float least = kLeastLines * ImGui::GetTextLineHeightWithSpacing();
  if (ImGui::BeginChild("trees", {0.f, std::max(least, ImGui::GetContentRegionAvail().y)}, true)) {
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(session.document().scene.stand.trees.size()));
    while (clipper.Step())
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
        const auto number = static_cast<std::size_t>(i);
        if (number >= session.document().scene.stand.trees.size()) break;
        const Placement& tree = session.document().scene.stand.trees[number];
        const std::string line = fmt::format("{:4}  {:8.2f} {:8.2f}  {}", i + 1, tree.position.x, tree.position.y,
                                             session.document().scene.kindOf(tree).name);
        if (ImGui::Selectable(line.c_str(), session.document().selected == number))
          session.attempt([&] { session.select(number); });
      }
  }
  ImGui::EndChild();
}

}  // namespace sunfleck::view
