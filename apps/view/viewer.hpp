#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/view/canvas.hpp"
#include "apps/view/compositor.hpp"
#include "apps/view/gui.hpp"
#include "apps/view/panels.hpp"
#include "apps/view/progressive_picture.hpp"
#include "apps/view/session.hpp"
#include "apps/view/view_script.hpp"
#include "apps/view/window.hpp"
#include "core/elapsed.hpp"
#include "render/compare/reference_picture.hpp"
#include "render/gl/context.hpp"
#include "render/gl/stand_picture.hpp"
#include "render/gl/stand_renderer.hpp"

namespace sunfleck::view {

struct ViewerOptions {
  std::string name;                // of the scene, for the title
  std::function<Document()> read;  // in the background
  glm::ivec2 size{1440, 900};      // of the window [pixel]
  bool offscreen = false;          // no window
  std::string script_name;
  std::vector<ScriptStep> script;
  std::optional<int> frames;  // after which it ends
  bool ends = false;          // when the script has ended
  Look look;
  std::function<bool()> interrupted;
};

// The program that a person looks at: it draws the session's document, hands what mouse, keys and scripts do to the
// session, and shows its panels.
class Viewer {
 public:
  // Throws std::runtime_error that names what is missing: a display, OpenGL 4.5.
  explicit Viewer(const ViewerOptions& options);
  // Until it is ended. Throws InvalidInput on a scene or script that is wrong, std::runtime_error on what a script
  // expected in vain and on what OpenGL reports.
  void run();

 private:
  enum class Drag { none, turn, shift, tree, sun, wipe, paint };
  // A picture with layers that is drawn frame by frame for a file.
  struct Exr {
    std::filesystem::path file;
    gl::PictureByFrames picture;
  };
  // What Monte Carlo was begun for.
  struct ReferenceKey {
    Camera camera;
    std::uint64_t stand = 0;
    double target = 0.;
    bool operator==(const ReferenceKey&) const = default;
  };

  // What the difference was told of.
  struct ComparedKey {
    PictureKey a;
    std::optional<PictureKey> b;  // none: the reference
    int samples = 0;
    bool operator==(const ComparedKey&) const = default;
  };

  bool frame();
  Input nextInput();
  void act(const Input& input);
  void actByMouse(const Input& input, glm::vec2 place, glm::vec2 by);
  void beginDrag(const Input& input, glm::vec2 place);
  void click(glm::vec2 place);
  void actByKeys(const Input& input);
  void move(const Input& input);
  bool drawPictures();
  void compare();
  ReferenceKey referenceKey() const;
  void endStaleReference();
  std::optional<Shown> referenceShown();
  void overlay();
  void serve(Requests& requests);
  PictureKey keyOf(Model model) const;
  void beginExr(const std::filesystem::path& file);
  void drawExr();
  Probe probeAt(glm::vec2 place);
  bool still() const;  // what is drawn is up to date and smooth
  bool needsDrawing() const;
  bool waitsForWork() const;  // in the background, with nothing to draw until then
  void takeResult();
  bool settled() const;  // and the panels tell of it
  void savePng(const std::filesystem::path& file, const Canvas& canvas);
  void saveScene(const std::filesystem::path& file);

  // Does steps until one has to wait for frames.
  void advanceScript();
  bool hasTasks() const;  // that a script waits for
  void requireNoFailure() const;
  bool blocked(const ScriptStep& step);  // it waits
  void execute(const ScriptStep& step);
  void executeEdit(const ScriptStep& step);
  void executeLook(const ScriptStep& step);
  void executeInput(const ScriptStep& step);
  void expect(const ScriptStep& step);

  ViewerOptions options_;
  std::unique_ptr<Window> window_;
  std::unique_ptr<gl::Context> context_;
  Gui gui_;
  Session session_;
  Panels panels_;
  Requests requests_;
  FrameReport report_;
  gl::StandRenderer renderer_;
  Compositor compositor_;
  Canvas canvas_, picture_;
  ProgressivePicture a_, b_;
  std::optional<gl::FrameTarget> probe_target_;  // of one pixel
  std::uint64_t stand_ = 0;                      // which the renderer holds; 0: none
  std::size_t drawn_trees_ = 0;                  // of that stand
  std::uint64_t field_ = 0;                      // revision of its light field; 0: none
  Model model_ = Model::sppg;                    // the document's, as soon as it can be drawn
  std::optional<Exr> exr_;
  ReferencePicture tracing_;
  ImageTexture reference_texture_;
  ReferencePicture::Snapshot reference_;       // the last one seen
  std::optional<ReferenceKey> reference_key_;  // that it runs for
  Elapsed reference_clock_;
  double looked_seconds_ = -1., looking_seconds_ = 0.;
  std::optional<ComparedKey> compared_;
  float largest_difference_ = 0.f;  // but for outliers
  bool flipped_ = false;

  glm::ivec2 corner_{0};  // of the picture in the window [pixel]
  Input input_, before_;
  Drag drag_ = Drag::none;
  bool dragged_ = false;    // further than a click may move
  glm::vec2 pressed_{0.f};  // where the drag began
  std::uint64_t gesture_ = 0;
  glm::vec2 grip_{0.f};  // of a tree: from its place to where it was taken hold of on the ground [m]
  std::optional<glm::vec2> probed_;
  int rested_ = 0;  // frames since the mouse moved

  std::size_t next_step_ = 0;
  int still_frames_ = 0;
  int frames_left_ = 0;          // that a step waits for
  std::deque<Input> synthetic_;  // that a script asks for
  Input scripted_;               // mouse and keys as a script left them
  bool scripted_mouse_ = false;
  int frame_count_ = 0;
  Elapsed clock_;
  double last_seconds_ = 0., drawn_seconds_ = -1.;
};

}  // namespace sunfleck::view
