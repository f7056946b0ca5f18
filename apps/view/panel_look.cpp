#include <fmt/format.h>
#include <imgui.h>

#include "apps/view/detail/widgets.hpp"
#include "apps/view/panels.hpp"

namespace sunfleck::view {

const char* aboutOf(Model model) {
  switch (model) {
    case Model::ss:
      return "Light scattered once: fast and too dark";
    case Model::spp:
      return "Simplified plane-parallel slab: all orders, but as if the crown had no edge";
    case Model::sppg:
      return "The slab compensated for the crown's edge by G";
    case Model::sppr:
      return "SPP refined by one more scattering, with G";
    case Model::nstreamg:
      return "A slab by two streams in each half, with G";
    case Model::pp:
      return "The exact slab, from a table made once for these leaves, with G";
    case Model::field:
      return "Light that leaves, wood and ground exchange, solved for in the background; on cells, some per cent off, "
             "until "
             "that is done";
  }
  return "";
}

void Panels::drawModel(Session& session) {
  const Document& document = session.document();
  Look& look = session.look;
  heading("Scattering model");
  for (const Model model : kModels) {
    if (ImGui::RadioButton(nameOf(model).c_str(), document.model == model))
      session.attempt([&] { session.edit(SetModel{model}); });
    tip(aboutOf(model));
  }
  if (!session.fieldText().empty()) ImGui::TextDisabled("%s", session.fieldText().c_str());
  heading("Picture");
  if (ImGui::BeginCombo("shows", nameOf(look.layer).c_str())) {
    for (const Layer layer : kLayers)
      if (ImGui::Selectable(nameOf(layer).c_str(), look.layer == layer)) look.layer = layer;
    ImGui::EndCombo();
  }
  tip("All light, or that of one scattering, or depth, thickness and G of what is seen");
  ImGui::SliderFloat("exposure", &look.display.exposure, 0.05f, 100.f, "%.2f", ImGuiSliderFlags_Logarithmic);
  tip("Factor from radiance [1/sr] to brightness");
  if (ImGui::BeginCombo("tone", nameOf(look.display.curve).c_str())) {
    for (const ToneCurve tone : kTones)
      if (ImGui::Selectable(nameOf(tone).c_str(), tone == look.display.curve)) look.display.curve = tone;
    ImGui::EndCombo();
  }
  tip("clamp: light as it is; filmic: shadows a little deeper, highlights that fade");
  ImGui::SliderInt("samples", &look.samples, 1, 64);
  tip("Per pixel, drawn one after the other while nothing moves");
  ImGui::Checkbox("fewer leaves far away", &look.fewer_leaves);
  tip("Leaves much smaller than a pixel are drawn fewer and larger; their light is that of the full tree");
  bool perspective = session.camera.perspective();
  if (ImGui::Checkbox("perspective", &perspective))
    session.camera = perspective ? inPerspective(session.camera, kWideView) : orthographic(session.camera);
  tip("As an eye sees it; else all lines of sight are parallel");
  if (perspective) {
    float degrees = session.camera.field_of_view * 57.29578f;
    if (ImGui::SliderFloat("field of view", &degrees, 5.f, 120.f, "%.0f\u00b0"))
      session.camera = inPerspective(session.camera, degrees / 57.29578f);
    tip("Of the picture's width [degrees]");
  }
  int navigation = static_cast<int>(look.navigation);
  if (ImGui::Combo("mouse", &navigation, "orbit\0fly\0walk\0")) look.navigation = static_cast<Navigation>(navigation);
  tip("Orbit: drag turns about the target. Fly, walk: drag looks around; W A S D (Q E) move");

  heading("Quality of the light");
  GeometryEffort effort = document.effort;
  const auto choice = [&](const char* name, int& value, std::initializer_list<int> values, const char* about) {
    if (ImGui::BeginCombo(name, fmt::format("{}", value).c_str())) {
      for (const int of : values)
        if (ImGui::Selectable(fmt::format("{}", of).c_str(), of == value) && of != value) {
          value = of;
          session.attempt([&] { session.edit(SetEffort{effort}); });
        }
      ImGui::EndCombo();
    }
    tip(about);
  };
  choice("directions", effort.sample_directions, {6, 14, 22, 48, 96}, "Sample directions of G and of the sky's light");
  choice("light map", effort.light_resolution, {128, 256, 512, 1024, 2048, 4096},
         "Pixels along the light's opacity map of each kind");
  choice("sample maps", effort.sample_resolution, {128, 256, 512}, "Pixels along the maps in the sample directions");
  choice("cells", effort.cells, {8, 16, 24, 32}, "Along the longest side of a tree");
}

}  // namespace sunfleck::view
