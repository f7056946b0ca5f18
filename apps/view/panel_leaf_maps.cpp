#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <cstdint>

#include "apps/view/detail/widgets.hpp"
#include "apps/view/panels.hpp"

namespace sunfleck::view {
namespace {

constexpr std::array kLowerWays{"as the upper", "numbers", "images"};

std::size_t lowerWayOf(const LeafTextures& textures) {
  return textures.lower.any() ? 2 : textures.underside.any() ? 1 : 0;
}

bool tellsGloss(LeafImage image) {
  return image == LeafImage::upper_gloss || image == LeafImage::lower_gloss;
}

// A quarter of the panel's width, with what it shows below.
void picture(const LeafThumbnails::Uploaded& thumbnail, const char* name, const char* about) {
  constexpr float kSide = 4.3f;  // of the longer one, in heights of a letter
  const float scale = kSide * ImGui::GetFontSize() / static_cast<float>(std::max(thumbnail.width, thumbnail.height));
  ImGui::BeginGroup();
  ImGui::Image(reinterpret_cast<ImTextureID>(std::intptr_t{thumbnail.name}),
               {scale * static_cast<float>(thumbnail.width), scale * static_cast<float>(thumbnail.height)});
  ImGui::TextDisabled("%s", name);
  ImGui::EndGroup();
  tip(about);
}

glm::vec3 perBand(const BandOptics& leaf, float LeafOptics::*member) {
  return {leaf[0].*member, leaf[1].*member, leaf[2].*member};
}

}  // namespace

bool Panels::drawLeafMaps(LeafTextures& textures, const TreeKind& of, Session& session) {
  for (const LeafImage image : kLeafImages) {
    LeafTextures now = textures;
    const auto& texture = imageOf(now, image);
    if (texture != imageOf(leaf_images_told, image) && texture)
      leaf_files[static_cast<std::size_t>(image)] = texture->file.string();
  }
  leaf_images_told = textures;
  bool edited = false;
  heading("Upper side");
  drawLeafImage(LeafImage::upper, "albedo and thickness", textures, session);
  drawLeafImage(LeafImage::upper_gloss, "gloss and roughness", textures, session);
  drawImagesOf(textures.upper);
  edited |= drawLowerSide(textures, of.told(), session);
  if (textures.upper.detail || textures.lower.detail) {
    heading("Factors of the images");
    edited |=
        changed(ImGui::DragFloat3("albedo##factor", &textures.albedo.x, 0.01f, 0.f, kMostLeafAlbedo, "%.2f"), session);
    tip("What a colour of 1 multiplies the reflectance by: red, green, blue, 0 to 100");
    const bool tissue = std::holds_alternative<LeafByTissue>(of.description);
    constexpr double kLeastRelief = 0., kMostRelief = 1.;  // that a drag reaches [mm]
    ImGui::BeginDisabled(!tissue);
    edited |= changed(
        ImGui::SliderScalar("relief", ImGuiDataType_Double, &textures.relief, &kLeastRelief, &kMostRelief, "%.3f mm"),
        session);
    ImGui::EndDisabled();
    tip(tissue ? "Thickness that an alpha of 1 adds to the leaf's and one of 0 takes from it [mm]"
               : "Of leaves told as a slab of tissue alone");
  }
  if (asked_for_leaf_image) {
    if (session.messageIsError()) {
      ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(1.f, 0.55f, 0.4f, 1.f));
      ImGui::TextWrapped("%s", session.message().c_str());
      ImGui::PopStyleColor();
    } else if (!session.hasTasks()) {
      asked_for_leaf_image = false;
    }
  }
  return edited;
}

void Panels::drawLeafImage(LeafImage image, const char* about, const LeafTextures& textures, Session& session) {
  LeafTextures now = textures;
  const auto& texture = imageOf(now, image);
  const bool gloss = tellsGloss(image);
  ImGui::PushID(static_cast<int>(image));
  std::string& file = leaf_files[static_cast<std::size_t>(image)];
  ImGui::TextDisabled("%s", about);
  const float letter = ImGui::GetFontSize();
  ImGui::SetNextItemWidth(-7.4f * letter);
  ImGui::InputText("##file", &file);
  tip(gloss
          ? "An image whose colours are the intensity of the gloss and whose alpha is its roughness, by linear values"
          : "An image whose colours times the factors below multiply the reflectance and whose alpha is thickness, by "
            "linear values");
  ImGui::SameLine();
  ImGui::BeginDisabled(file.empty());
  const bool read = ImGui::Button("read");
  ImGui::EndDisabled();
  tip("Reads the file, in the background; all images of a leaf are of one size");
  ImGui::SameLine();
  ImGui::BeginDisabled(!texture);
  const bool remove = ImGui::Button("none");
  ImGui::EndDisabled();
  tip("The leaf without this image");
  ImGui::PopID();
  if (read || remove) asked_for_leaf_image = true;
  if (read) session.attempt([&] { session.setLeafImage(kind, image, file); });
  if (remove) session.attempt([&] { session.edit(SetLeafImage{kind, image, nullptr}); });
}

void Panels::drawImagesOf(const LeafSideTextures& side) {
  bool first = true;
  const auto show = [&](const std::shared_ptr<const LeafTexture>& texture, LeafImagePart part, const char* name,
                        const char* about) {
    if (!texture || (part == LeafImagePart::alpha && texture->alpha.empty())) return;
    if (!first) ImGui::SameLine(0.f, 0.4f * ImGui::GetFontSize());
    first = false;
    picture(
        thumbnails.of(texture, part), name,
        fmt::format("{}; {}, {} x {} pixels", about, texture->file.string(), texture->width, texture->height).c_str());
  };
  show(side.detail, LeafImagePart::colour, "albedo", "What multiplies the reflectance, times the factors");
  show(side.detail, LeafImagePart::alpha, "thickness", "Black: thinner by the relief, white: thicker by it");
  show(side.gloss, LeafImagePart::colour, "gloss", "Its intensity, white: 1");
  show(side.gloss, LeafImagePart::alpha, "roughness", "Of the gloss, black: 0.05 or below, white: 1");
}

bool Panels::drawLowerSide(LeafTextures& textures, const BandOptics& told, Session& session) {
  heading("Lower side");
  if (textures.lower.any() || textures.underside.any()) chooses_lower_images = false;
  const std::size_t now = chooses_lower_images ? 2 : lowerWayOf(textures);
  std::size_t chosen = now;
  if (ImGui::BeginCombo("told by##lower", kLowerWays[now])) {
    for (std::size_t way = 0; way < kLowerWays.size(); ++way)
      if (ImGui::Selectable(kLowerWays[way], way == now)) chosen = way;
    ImGui::EndCombo();
  }
  tip("What is different on the lower side; light goes through the leaf alike both ways");
  bool edited = false;
  if (chosen != now) {
    chooses_lower_images = chosen == 2;
    edited = textures.lower.any() || textures.underside.any() || chosen == 1;
    if (edited) gesture = session.newGesture();
    textures.lower = {};
    textures.underside = {};
    if (chosen == 1) textures.underside.reflectance = perBand(told, &LeafOptics::reflectance);
  }
  if (chosen == 2) {
    drawLeafImage(LeafImage::lower, "albedo and thickness", textures, session);
    drawLeafImage(LeafImage::lower_gloss, "gloss and roughness", textures, session);
    drawImagesOf(textures.lower);
  }
  if (chosen == 1) edited |= drawUnderside(textures.underside, told, session);
  return edited;
}

// The last number that is told stays: without any the lower side would be as the upper.
bool Panels::drawUnderside(LeafUnderside& underside, const BandOptics& told, Session& session) {
  bool edited = false;
  const auto own = [&](const char* id, auto& value, const auto& otherwise) {
    bool has = value.has_value();
    if (ImGui::Checkbox(id, &has)) {
      gesture = session.newGesture();
      if (has)
        value = otherwise;
      else
        value.reset();
      edited = true;
    }
    tip("Whether the lower side has its own; else it is as the upper's");
    ImGui::SameLine();
    ImGui::BeginDisabled(!has);
  };
  const LeafUnderside before = underside;
  glm::vec3 reflectance = before.reflectance.value_or(perBand(told, &LeafOptics::reflectance));
  own("##reflects", underside.reflectance, reflectance);
  if (changed(ImGui::DragFloat3("reflectance##lower", &reflectance.x, 0.002f, 0.f, 1.f, "%.2f"), session)) {
    underside.reflectance = reflectance;
    edited = true;
  }
  ImGui::EndDisabled();
  tip("Of the lower side: red, green, blue; with what the leaf lets through at most 1");
  glm::vec3 gloss = before.gloss.value_or(perBand(told, &LeafOptics::gloss));
  own("##shines", underside.gloss, gloss);
  if (changed(ImGui::DragFloat3("gloss##lower", &gloss.x, 0.002f, 0.f, 1.f, "%.2f"), session)) {
    underside.gloss = gloss;
    edited = true;
  }
  ImGui::EndDisabled();
  tip("Of the lower side: red, green, blue");
  float roughness = before.gloss_roughness.value_or(told[0].gloss_roughness);
  own("##rough", underside.gloss_roughness, roughness);
  if (changed(ImGui::SliderFloat("roughness##lower", &roughness, kLeastGlossRoughness, 1.f, "%.2f"), session)) {
    underside.gloss_roughness = roughness;
    edited = true;
  }
  ImGui::EndDisabled();
  tip("Of the lower side's gloss");
  if (!underside.any()) underside = before;
  return edited;
}

// What the leaves of the picture do, which are those of the document as soon as they have been made.
void Panels::drawMadeMaps(const Session& session) {
  const auto& scene = session.shownScene();
  if (!scene || kind >= scene->kinds.size() || !scene->kinds[kind].maps) return;
  const TreeKind& made = scene->kinds[kind];
  const float letter = ImGui::GetFontSize();
  picture(thumbnails.of(made.maps, LeafMapPart::upper_reflectance), "upper",
          "What the upper side reflects at each place, beneath the gloss");
  ImGui::SameLine(0.f, 0.4f * letter);
  picture(thumbnails.of(made.maps, LeafMapPart::lower_reflectance), "lower",
          "What the lower side reflects at each place, beneath the gloss");
  ImGui::SameLine(0.f, 0.4f * letter);
  picture(thumbnails.of(made.maps, LeafMapPart::transmittance), "through",
          "What each place lets through, the same both ways");
  if (!beginRows("mean")) return;
  std::string reflectance, transmittance;
  for (const LeafOptics& band : made.leaf) {
    reflectance += fmt::format("{:.3f}  ", band.reflectance);
    transmittance += fmt::format("{:.3f}  ", band.transmittance);
  }
  row("mean reflectance", reflectance);
  tip("Over both sides and all of the leaf area, which stands for the leaf where it is not seen itself");
  row("mean transmittance", transmittance);
  ImGui::EndTable();
}

}  // namespace sunfleck::view
