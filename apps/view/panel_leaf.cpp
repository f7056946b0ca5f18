#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>

#include "apps/view/detail/widgets.hpp"
#include "apps/view/panels.hpp"
#include "leaves/measured_leaves.hpp"
#include "leaves/slab_leaf.hpp"

namespace sunfleck::view {
namespace {

constexpr std::array kWays{"numbers", "measured species", "contents", "slab of tissue"};

std::size_t wayOf(const LeafDescription& leaf) {
  if (const auto* contents = std::get_if<LeafByContents>(&leaf)) return contents->species.empty() ? 2 : 1;
  return std::holds_alternative<LeafByTissue>(leaf) ? 3 : 0;
}

// Tissue that looks as these leaves do, as far as tissue can.
LeafByTissue tissueLike(const BandOptics& optics) {
  constexpr double kLeastTransmittance = 1e-4;  // that tissueOf() takes
  LeafByTissue leaf;
  std::array<LeafSides, kBands> sides;
  for (std::size_t band = 0; band < kBands; ++band) {
    const double transmittance = std::max(double{optics[band].transmittance}, kLeastTransmittance);
    sides[band] = {.reflectance = std::min(double{optics[band].reflectance}, 1. - transmittance),
                   .transmittance = transmittance};
  }
  const std::vector<TissueFit> found = tissueOf(sides, leaf.thickness);
  for (int band = 0; band < kBands; ++band) {
    const LeafTissue& tissue = found[static_cast<std::size_t>(band)].tissue;
    leaf.absorption[band] = static_cast<float>(tissue.absorption);
    leaf.scattering[band] = static_cast<float>(tissue.scattering);
  }
  return leaf;
}

// "carbon_constituents" and "ug/cm^2" as people write them.
std::string spelled(std::string_view name) {
  std::string text(name);
  std::ranges::replace(text, '_', ' ');
  return text;
}
std::string unitOf(const LeafContent& content) {
  std::string unit(content.unit);
  if (unit.starts_with("ug")) unit.replace(0, 2, "\u00b5g");
  if (unit.ends_with("^2")) unit.replace(unit.size() - 2, 2, "\u00b2");
  return unit;
}

// A value's format, with its unit.
std::string formatOf(const LeafContent& content) {
  const int digits = content.usual_high >= 10. ? 1 : content.usual_high >= 1. ? 2 : 4;
  return fmt::format("%.{}f {}", digits, unitOf(content));
}

bool slide(const char* name, double& value, double high, const char* format, ImGuiSliderFlags flags, double low = 0.) {
  return ImGui::SliderScalar(name, ImGuiDataType_Double, &value, &low, &high, format, flags);
}

// The leaf so far as it follows from what it is, and in which bands.
void tellOptics(const BandOptics& leaf, const LightBands& bands, bool of_bands) {
  if (!beginRows("follows")) return;
  std::string reflectance, transmittance, told;
  for (std::size_t band = 0; band < kBands; ++band) {
    reflectance += fmt::format("{:.3f}  ", leaf[band].reflectance);
    transmittance += fmt::format("{:.3f}  ", leaf[band].transmittance);
    if (bands)
      told += (*bands)[band].low == (*bands)[band].high
                  ? fmt::format("{:g}  ", (*bands)[band].low)
                  : fmt::format("{:g}-{:g}  ", (*bands)[band].low, (*bands)[band].high);
  }
  row("reflectance", reflectance);
  row("transmittance", transmittance);
  if (of_bands) row("bands", bands ? told + "nm" : "red, green, blue");
  ImGui::EndTable();
}

}  // namespace

void Panels::drawLeaf(Session& session) {
  const Scene& scene = session.document().scene;
  kind = std::min(kind, static_cast<std::uint32_t>(scene.kinds.size() - 1));
  if (scene.kinds.size() > 1 && ImGui::BeginCombo("kind", scene.kinds[kind].name.c_str())) {
    for (std::uint32_t i = 0; i < scene.kinds.size(); ++i)
      if (ImGui::Selectable(scene.kinds[i].name.c_str(), i == kind)) kind = i;
    ImGui::EndCombo();
  }
  BandOptics leaf = scene.kinds[kind].told();
  LeafDescription description = scene.kinds[kind].description;
  glm::vec3 wood = scene.kinds[kind].wood_reflectance;
  heading("Leaves");
  bool edited = chooseDescription(description, leaf, session);
  if (auto* contents = std::get_if<LeafByContents>(&description))
    edited |= drawContents(*contents, session);
  else if (auto* tissue = std::get_if<LeafByTissue>(&description))
    edited |= drawTissue(*tissue, session);
  else
    edited |= drawNumbers(leaf, session);
  if (!std::holds_alternative<LeafByNumbers>(description))
    tellOptics(leaf, scene.bands, std::holds_alternative<LeafByContents>(description));
  LeafTextures textures = scene.kinds[kind].textures;
  if (textures.any()) drawMadeMaps(session);
  float gloss = leaf[0].gloss, roughness = leaf[0].gloss_roughness;
  edited |= changed(ImGui::SliderFloat("gloss", &gloss, 0.f, 1.f, "%.2f"), session);
  tip("Intensity of a glossy reflection on both sides; the shares above are then of the light it lets in");
  edited |= changed(ImGui::SliderFloat("roughness", &roughness, kLeastGlossRoughness, 1.f, "%.2f"), session);
  tip("Of the gloss: root mean square slope of its facets");
  for (LeafOptics& band : leaf) {
    band.gloss = gloss;
    band.gloss_roughness = roughness;
  }
  edited |= drawLeafMaps(textures, scene.kinds[kind], session);
  heading("Wood");
  edited |= changed(ImGui::ColorEdit3("reflectance##wood", &wood.x, ImGuiColorEditFlags_Float), session);
  tip("Lambertian, per band, 0 to 1");
  if (edited) session.attempt([&] { session.edit(SetOptics{kind, leaf, wood, description, textures}, gesture); });
}

// Leaves told in another way look as before where that is possible.
bool Panels::chooseDescription(LeafDescription& leaf, const BandOptics& optics, Session& session) {
  const std::size_t now = wayOf(leaf);
  std::size_t chosen = now;
  if (ImGui::BeginCombo("told by", kWays[now])) {
    for (std::size_t way = 0; way < kWays.size(); ++way)
      if (ImGui::Selectable(kWays[way], way == now)) chosen = way;
    ImGui::EndCombo();
  }
  tip("How the leaves of this kind are told: reflectance and transmittance themselves, or what they follow from");
  if (chosen == now) return false;
  gesture = session.newGesture();
  const auto* contents = std::get_if<LeafByContents>(&leaf);
  if (chosen == 0)
    leaf = LeafByNumbers{};
  else if (chosen == 1)
    leaf = leafOfSpecies(measured_species);
  else if (chosen == 2)
    leaf = LeafByContents{.species = {}, .contents = contents ? contents->contents : LeafContents{}};
  else
    leaf = tissueLike(optics);
  return true;
}

bool Panels::drawNumbers(BandOptics& leaf, Session& session) {
  bool edited = false;
  float albedo = 0.f;
  for (const LeafOptics& band : leaf) albedo += band.albedo() / static_cast<float>(kBands);
  if (changed(ImGui::SliderFloat("albedo", &albedo, 0.f, 1.f, "%.3f"), session)) {
    for (LeafOptics& band : leaf) band.reflectance = band.transmittance = 0.5f * albedo;
    edited = true;
  }
  tip("Share of light that leaves scatter, half of it reflected, in all bands; 0.95 in the paper's experiment");
  glm::vec3 reflectance, transmittance;
  for (int band = 0; band < kBands; ++band) {
    reflectance[band] = leaf[static_cast<std::size_t>(band)].reflectance;
    transmittance[band] = leaf[static_cast<std::size_t>(band)].transmittance;
  }
  const bool by_reflectance =
      changed(ImGui::DragFloat3("reflectance", &reflectance.x, 0.002f, 0.f, 1.f, "%.3f"), session);
  tip("Share sent back on the side it came from: red, green, blue");
  const bool by_transmittance =
      changed(ImGui::DragFloat3("transmittance", &transmittance.x, 0.002f, 0.f, 1.f, "%.3f"), session);
  tip("Share sent on through the leaf: red, green, blue. With the reflectance at most 1");
  for (int band = 0; band < kBands && (by_reflectance || by_transmittance); ++band) {
    LeafOptics& of = leaf[static_cast<std::size_t>(band)];
    of.reflectance = by_reflectance ? std::min(reflectance[band], 1.f - of.transmittance) : of.reflectance;
    of.transmittance = by_transmittance ? std::min(transmittance[band], 1.f - of.reflectance) : of.transmittance;
    edited = true;
  }
  return edited;
}

bool Panels::drawContents(LeafByContents& leaf, Session& session) {
  bool edited = false;
  if (!leaf.species.empty()) {
    const MeasuredLeaf& measured = measuredLeaf(leaf.species);
    const bool differs = leaf.contents != measured.contents;
    if (ImGui::BeginCombo("species", (leaf.species + (differs ? ", changed" : "")).c_str())) {
      for (const std::string& name : measuredLeafNames())
        if (ImGui::Selectable(name.c_str(), name == leaf.species)) {
          leaf = leafOfSpecies(name);
          measured_species = name;
          gesture = session.newGesture();
          edited = true;
        }
      ImGui::EndCombo();
    }
    tip(fmt::format("{}. {}{}", measured.title, measured.source, measured.caveat.empty() ? "" : ". " + measured.caveat)
            .c_str());
  }
  const bool parts = leaf.contents.protein != 0. || leaf.contents.carbon_constituents != 0.;
  for (const LeafContent& content : leafContents()) {
    const bool is_part = content.value == &LeafContents::protein || content.value == &LeafContents::carbon_constituents;
    if (is_part ? !parts : parts && content.value == &LeafContents::dry_matter) continue;
    const bool small = content.usual_high < 1.;
    edited |= changed(slide(spelled(content.name).c_str(), leaf.contents.*content.value, content.usual_high,
                            formatOf(content).c_str(), small ? ImGuiSliderFlags_Logarithmic : 0, content.low),
                      session);
    tip(fmt::format("{} of PROSPECT{}; {:g} to {:g}{}; Ctrl and click to type more", content.symbol,
                    content.unit.empty() ? "" : " [" + unitOf(content) + "]", content.low, content.usual_high,
                    leaf.species.empty() ? "" : ". Of the species; what is changed here is kept beside its name")
            .c_str());
  }
  return edited;
}

bool Panels::drawTissue(LeafByTissue& leaf, Session& session) {
  constexpr float kMostAbsorption = 100.f, kMostScattering = 200.f;  // that a drag reaches [1/mm]
  constexpr double kMostThickness = 1.;                              // [mm]
  bool edited =
      changed(ImGui::DragFloat3("absorption /mm", &leaf.absorption.x, 0.02f, 0.f, kMostAbsorption, "%.2f"), session);
  tip("Absorption coefficient [1/mm]: red, green, blue");
  edited |=
      changed(ImGui::DragFloat3("scattering /mm", &leaf.scattering.x, 0.1f, 0.f, kMostScattering, "%.2f"), session);
  tip("Scattering coefficient, the same in all directions [1/mm]: red, green, blue");
  edited |= changed(slide("thickness", leaf.thickness, kMostThickness, "%.3f mm", 0), session);
  tip("Of the leaf [mm]; thicker leaves reflect more and let less through");
  return edited;
}

}  // namespace sunfleck::view
