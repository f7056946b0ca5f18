#pragma once

#include <array>
#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/view/leaf_thumbnails.hpp"
#include "apps/view/session.hpp"
#include "leaves/leaf_description.hpp"
#include "render/compare/picture_difference.hpp"

namespace sunfleck::view {

// What a click in the picture does.
enum class Tool { select, add, paint };

enum class Tab { scene, light, leaf, model, compare, probe, times, files };
inline constexpr std::array kTabs{Tab::scene,   Tab::light, Tab::leaf,  Tab::model,
                                  Tab::compare, Tab::probe, Tab::times, Tab::files};
const char* nameOf(Tab tab);

// What is seen at one pixel.
struct Probe {
  glm::ivec2 pixel{0};
  std::string what = "sky";  // kind and leaf, wood, ground
  std::optional<std::size_t> tree;
  std::optional<glm::vec3> place;                                              // [m]
  glm::vec3 radiance{0.f}, direct{0.f}, single{0.f}, multiple{0.f}, sky{0.f};  // [1/sr]
  std::optional<float> depth, thickness, compensation;                         // where there is a leaf [1]
};

// What the viewer measured, for the panels to tell.
struct FrameReport {
  std::vector<float> frame_ms;                            // of the last frames
  std::vector<std::pair<std::string, double>> passes_ms;  // of the last drawing
  double sent_ms = 0.;                                    // of the last sending to the graphics card
  std::size_t sent_bytes = 0;
  int samples = 0;       // in the picture shown
  std::string renderer;  // what OpenGL draws with
  std::optional<Probe> probe;
  std::optional<PictureError> error;  // of A against B, both whole; none where there is nothing to compare
  float difference_scale = 0.f;       // that the colours tell [1/sr]
  // Monte Carlo, where it is B.
  bool reference_runs = false, reference_finished = false;
  double reference_noise = 0., reference_seconds = 0., reference_done = 0.;
  std::string reference_failure;
  std::optional<double> exr_done;  // share of an EXR's frames, while it is drawn
};

// What the panels ask the viewer for.
struct Requests {
  std::optional<std::filesystem::path> screenshot, exr, scene;
  bool cancel = false;  // what is under way
};

// The panels' own state.
struct Panels {
  bool shown = true;
  Tab left = Tab::scene, right = Tab::compare;
  bool choose_left = true, choose_right = true;  // the tab that is named is to be brought to the front
  Tool tool = Tool::select;
  std::uint32_t kind = 0;                         // to add and to paint
  float paint_radius = 5.f, paint_spacing = 3.f;  // [m]
  std::size_t sun = 0;                            // that is edited
  std::uint64_t gesture = 0;
  std::string measured_species = "beech";  // the last one chosen
  // What is typed.
  std::string new_kind = "maple", date = "2026-06-21", time = "12:00", camera_name = "view";
  int new_seed = 1;
  float latitude = 48.f, longitude = 9.f;
  std::string picture_file = "view.png", exr_file = "view.exr", scene_file = "view.toml", sky_file = "sky.hdr";
  bool chooses_image = false;  // as the sky, but has not read it yet
  std::array<std::string, kLeafImages.size()> leaf_files;
  LeafTextures leaf_images_told;      // when these files were last told
  bool chooses_lower_images = false;  // of leaves, but has none yet
  bool asked_for_leaf_image = false;  // what goes wrong then is told beside it
  LeafThumbnails thumbnails{uploadedThumbnail};
  float sky_rotation = 0.f;  // [degrees]

  void show(Tab tab);
  // Draws all for a window of this size; gives the part of it that is left for the picture: corner and size [pixel].
  std::pair<glm::ivec2, glm::ivec2> draw(glm::ivec2 window, Session& session, const FrameReport& report,
                                         Requests& requests);

 private:
  void drawTab(Tab tab, Session& session, const FrameReport& report, Requests& requests);
  void drawStatus(glm::ivec2 window, float height, Session& session, const FrameReport& report, Requests& requests);
  void drawScene(Session& session);
  void drawTrees(Session& session);
  void drawLight(Session& session);
  void drawSun(Session& session);
  void drawSky(Session& session);
  void drawSkyImage(Session& session, const SceneSky& sky);
  void drawLeaf(Session& session);
  bool chooseDescription(LeafDescription& leaf, const BandOptics& optics, Session& session);
  bool drawNumbers(BandOptics& leaf, Session& session);
  bool drawContents(LeafByContents& leaf, Session& session);
  bool drawTissue(LeafByTissue& leaf, Session& session);
  // What tells places and sides apart; whether numbers were edited.
  bool drawLeafMaps(LeafTextures& textures, const TreeKind& of, Session& session);
  void drawLeafImage(LeafImage image, const char* about, const LeafTextures& textures, Session& session);
  void drawImagesOf(const LeafSideTextures& side);
  bool drawLowerSide(LeafTextures& textures, const BandOptics& told, Session& session);
  bool drawUnderside(LeafUnderside& underside, const BandOptics& told, Session& session);
  void drawMadeMaps(const Session& session);
  void drawModel(Session& session);
  void drawCompare(Session& session, const FrameReport& report);
  void drawProbe(Session& session, const FrameReport& report);
  void drawTimes(Session& session, const FrameReport& report);
  void drawFiles(Session& session, Requests& requests);
  // After an item that edits: whether it did; a new gesture begins where a person took hold of it.
  bool changed(bool changed, Session& session);
};

// What a model does, for people.
const char* aboutOf(Model model);

// The colour of a difference, -1 .. 1: blue where B is brighter, red where A is.
glm::vec3 differenceColour(float difference);

}  // namespace sunfleck::view
