#include <fmt/format.h>

#include <filesystem>

#include "apps/commands.hpp"
#include "apps/display_options.hpp"
#include "apps/pictures.hpp"
#include "apps/scene_options.hpp"
#include "apps/terminal.hpp"
#include "apps/view/view_script.hpp"
#include "apps/view/viewer.hpp"

namespace sunfleck::apps {
namespace {

struct ViewOptions {
  SceneOptions scene;
  CameraOptions camera;
  std::string model = "sppg", script;
  std::vector<int> window{1440, 900};
  std::optional<int> frames;
  DisplayOptions display;
  bool offscreen = false;
};

int runView(const ViewOptions& options) {
  view::ViewerOptions viewer;
  viewer.name = options.scene.scene;
  viewer.read = [options] {
    view::Document document;
    document.model = modelNamed(options.model).value_or(document.model);
    document.scene = readScene(options.scene, Media::refused, Treeless::taken);
    apply(options.camera, document.scene);
    if (std::filesystem::path(options.scene.scene).extension() != ".toml") showGround(document.scene);
    return document;
  };
  viewer.size = {options.window[0], options.window[1]};
  viewer.offscreen = options.offscreen;
  viewer.look.display = options.display.display();
  if (!options.script.empty()) {
    viewer.script = view::readScript(options.script);
    viewer.script_name = options.script;
    viewer.ends = true;
  }
  viewer.frames = options.frames;
  viewer.interrupted = [] { return interrupted(); };
  view::Viewer(viewer).run();
  return interrupted() ? 1 : 0;
}

}  // namespace

void addView(CLI::App& app, RunOptions& options, int& status) {
  auto view = std::make_shared<ViewOptions>();
  CLI::App* command = addCommand(app, options, "view", "Look at a scene in a window, and change it");
  addSceneOptions(*command, view->scene);
  addCameraOptions(*command, view->camera);
  command->add_option("--model", view->model, "Scattering model to begin with: " + modelNames() + " (default sppg)")
      ->check([](const std::string& name) {
        return modelNamed(name) ? std::string() : "model \"" + name + "\": must be one of " + modelNames();
      });
  addDisplayOptions(*command, view->display);
  const std::string group = "Window";
  command->add_option("--window", view->window, "Width and height of the window, in pixels (default 1440 900)")
      ->expected(2)
      ->transform(wholeNumberIn(1., 16384., "a whole number, 1 to 16384"))
      ->group(group);
  command->add_flag("--offscreen", view->offscreen, "Draw without a window: for machines without a display")
      ->group(group);
  command->add_option("--script", view->script, "File of commands to carry out, one to a line; then it ends")
      ->group(group);
  command->add_option("--frames", view->frames, "Draw so many frames, then end")
      ->transform(wholeNumberIn(1., 1e9, "a whole number, 1 to 1e9"))
      ->group(group);
  command->footer("Commands of scripts (a text with spaces in double quotes, \"#\" begins a comment):\n" +
                  view::scriptHelp());
  command->callback([view, &status] { status = runView(*view); });
}

}  // namespace sunfleck::apps
