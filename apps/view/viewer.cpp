#include "apps/view/viewer.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <thread>

#include "core/require.hpp"
#include "render/compare/exact_powers.hpp"
#include "render/gl/stand_picture.hpp"
#include "render/image_file.hpp"
#include "render/scene_writer.hpp"

namespace sunfleck::view {
namespace {

constexpr std::size_t kTimes = 120;  // frames of the graph
constexpr double kIdleWait = 0.1;    // for something to happen when all is drawn [s]
constexpr double kBusyWait = 0.01;   // while the background works [s]

std::unique_ptr<Window> windowFor(const ViewerOptions& options) {
  return options.offscreen ? openOffscreen(options.size) : openWindow("Sunfleck: " + options.name, options.size);
}

std::unique_ptr<gl::Context> contextFor(const ViewerOptions& options) {
  return options.offscreen ? std::make_unique<gl::Context>()
                           : std::make_unique<gl::Context>(gl::Context::Of::the_current);
}

}  // namespace

Viewer::Viewer(const ViewerOptions& options)
    : options_(options),
      window_(windowFor(options)),
      context_(contextFor(options)),
      gui_(window_->scale()),
      session_(options.name, options.read),
      renderer_(*context_, exactPowerTable),
      tracing_(std::max(1, static_cast<int>(std::thread::hardware_concurrency()) - 1)) {
  session_.look = options.look;
  report_.renderer = context_->renderer();
}

void Viewer::run() {
  while (frame()) {
  }
  if (const std::size_t messages = context_->messages(); messages > 0 && !options_.script.empty())
    throw std::runtime_error(fmt::format("OpenGL reported {} messages while the script ran", messages));
}

bool Viewer::still() const {
  const bool b_is_drawn = session_.look.comparison == Comparison::off || !session_.look.other ||
                          (b_.done(session_.look.samples) && b_.key() == keyOf(*session_.look.other));
  if (stand_ == 0 || input_.size == glm::ivec2(0))  // nothing to be drawn
    return session_.upToDate() && !session_.work().busy && synthetic_.empty();
  return session_.upToDate() && !session_.work().busy && a_.done(session_.look.samples) &&
         a_.key() == keyOf(session_.document().model) && b_is_drawn && synthetic_.empty();
}

bool Viewer::settled() const {
  constexpr int kTold = 4;  // frames after which the panels have told all
  return still() && still_frames_ >= kTold;
}

// All that is drawn stays as it is until something happens, but for what the background tells of itself.
bool Viewer::needsDrawing() const {
  constexpr double kLookAgain = 0.4, kProgress = 0.1;  // [s]
  const bool same_input = input_.size == before_.size && input_.mouse == before_.mouse && input_.wheel == 0.f &&
                          std::equal(std::begin(input_.buttons), std::end(input_.buttons), before_.buttons) &&
                          input_.held == before_.held && input_.typed.empty() && input_.pressed.empty();
  if (!same_input || !synthetic_.empty() || frames_left_ > 0 || options_.frames) return true;
  const double seconds = clock_.seconds() - drawn_seconds_;
  if (settled()) return seconds > kLookAgain;
  return !waitsForWork() || seconds > kProgress;
}

bool Viewer::waitsForWork() const {
  if (!session_.loaded()) return true;
  return !session_.upToDate() && session_.work().busy &&
         (stand_ == 0 || (a_.done(session_.look.samples) && a_.key() == keyOf(session_.document().model)));
}

void Viewer::takeResult() {
  session_.advance();
  const auto result = session_.take();
  if (!result) return;
  const Elapsed sending;
  try {
    const gl::Sent sent = renderer_.update(gl::drawnStand(result->made.scene, *result->geometry));
    report_.sent_bytes = sent.meshes + sent.maps + sent.trees + sent.cells + sent.sky;
    stand_ = result->made.revision;
  } catch (const gl::TooLarge& e) {
    session_.say(e.what(), true);
    stand_ = 0;  // what the renderer holds is not to be drawn
  }
  report_.sent_ms = 1e3 * sending.seconds();
  drawn_trees_ = result->made.scene.stand.trees.size();
  session_.release(*result);
}

bool Viewer::frame() {
  advanceScript();
  before_ = input_;
  input_ = nextInput();
  if (input_.close || (options_.interrupted && options_.interrupted())) return false;
  takeResult();
  if (!needsDrawing()) return true;
  drawn_seconds_ = clock_.seconds();
  const Elapsed frame_time;
  if (input_.size != glm::ivec2(0)) {
    canvas_.resize(input_.size);
    const double now = clock_.seconds();
    gui_.begin(input_, static_cast<float>(now - last_seconds_));
    last_seconds_ = now;
    if (session_.loaded()) act(input_);
    const auto [corner, size] = panels_.draw(input_.size, session_, report_, requests_);
    corner_ = corner;
    session_.fit(size);
    picture_.resize(size);
    overlay();
  }
  if (input_.size != glm::ivec2(0)) {
    const bool drew = drawPictures();
    canvas_.bind();
    glClearColor(0.07f, 0.08f, 0.075f, 1.f);
    glClear(GL_COLOR_BUFFER_BIT);
    if (stand_ != 0) picture_.copyTo(canvas_, corner_);
    gui_.draw();
    window_->show(canvas_.framebuffer());
    context_->requireNoError("drawing a frame");
    if (drew) {
      report_.frame_ms.push_back(static_cast<float>(1e3 * frame_time.seconds()));
      if (report_.frame_ms.size() > kTimes) report_.frame_ms.erase(report_.frame_ms.begin());
    }
  }
  still_frames_ = still() ? still_frames_ + 1 : 0;
  serve(requests_);
  if (session_.loaded()) ++frame_count_;
  if (frames_left_ > 0) --frames_left_;
  if (options_.frames && frame_count_ >= *options_.frames) return false;
  return !(options_.ends && next_step_ == options_.script.size() && frames_left_ == 0 && synthetic_.empty());
}

Input Viewer::nextInput() {
  const bool scripted = next_step_ < options_.script.size() || options_.ends || options_.frames.has_value();
  double wait = 0.;
  if (waitsForWork())
    wait = kBusyWait;
  else if (settled() && drag_ == Drag::none)
    wait = scripted ? kBusyWait : kIdleWait;
  Input input = window_->poll(wait);
  if (options_.offscreen && wait > 0.) std::this_thread::sleep_for(std::chrono::duration<double>(wait));
  if (!synthetic_.empty()) {
    scripted_ = synthetic_.front();
    synthetic_.pop_front();
    scripted_mouse_ = true;
  } else {
    scripted_.wheel = 0.f;
    scripted_.pressed.clear();
    scripted_.held.assign(kKeys, false);
  }
  if (scripted_mouse_) {
    const glm::ivec2 size = input.size;
    const bool close = input.close;
    input = scripted_;
    input.size = size;
    input.close = close;
  }
  return input;
}

PictureKey Viewer::keyOf(Model model) const {
  return {.camera = session_.camera,
          .model = model,
          .layers = frameLayer(session_.look.layer) != gl::Layer::total,
          .fewer_leaves = session_.look.fewer_leaves,
          .stand = stand_};
}

// The last whole picture stays while the next stand is computed.
bool Viewer::drawPictures() {
  if (stand_ == 0) return false;
  const Look& look = session_.look;
  renderer_.timePasses(panels_.shown && panels_.right == Tab::times);  // it waits for each pass
  bool drew = a_.draw(renderer_, keyOf(session_.document().model), look.samples);
  const bool compares = look.comparison != Comparison::off || flipped_;
  endStaleReference();
  if (compares && look.other) drew |= b_.draw(renderer_, keyOf(*look.other), look.samples);
  if (drew)
    report_.passes_ms = {{"what is seen", 1e3 * a_.cost().visible_seconds},
                         {"shading", 1e3 * a_.cost().shading_seconds}};
  report_.samples = a_.samples();
  const auto shown = [&](const ProgressivePicture& picture) {
    return Shown{.texture = picture.target().texture(frameLayer(look.layer)),
                 .scale = 1.f / static_cast<float>(picture.samples()),
                 .layer = look.layer};
  };
  std::optional<Shown> b;
  if (compares && look.other) b = shown(b_);
  if (compares && !look.other) b = referenceShown();
  if (look.comparison != Comparison::off) compare();
  Look now = look;
  if (flipped_) now.comparison = look.comparison == Comparison::flip ? Comparison::off : Comparison::flip;
  compositor_.draw(picture_, shown(a_), b, now, std::max(report_.difference_scale, 1e-6f));
  return drew;
}

void Viewer::serve(Requests& requests) {
  if (!session_.loaded()) return;
  const auto write = [&](std::optional<std::filesystem::path>& file, auto&& save) {
    if (!file) return;
    session_.attempt([&] {
      save(*file);
      session_.say("wrote " + file->string());
    });
    file.reset();
  };
  write(requests.screenshot, [&](const auto& file) { saveScreenshot(file); });
  write(requests.window_screenshot, [&](const auto& file) { saveWindow(file); });
  write(requests.exr, [&](const auto& file) { saveExr(file); });
  write(requests.scene, [&](const auto& file) { saveScene(file); });
}

void Viewer::saveScreenshot(const std::filesystem::path& file) const {
  writePng(file, picture_.size().x, picture_.size().y, picture_.read());
}

void Viewer::saveWindow(const std::filesystem::path& file) const {
  writePng(file, canvas_.size().x, canvas_.size().y, canvas_.read());
}

void Viewer::saveExr(const std::filesystem::path& file) {
  if (file.extension() != ".exr") throw InvalidInput(file.string() + ": must end in .exr");
  requirePictureName(file);
  gl::PictureEffort effort{
      .model = session_.document().model, .samples = session_.look.samples, .layers = {}, .exact = exactPowerTable};
  for (int layer = 1; layer < gl::kLayers; ++layer) effort.layers.push_back(static_cast<gl::Layer>(layer));
  writeImage(file, gl::standPicture(*context_, renderer_, session_.camera, effort), 1.f);
}

void Viewer::saveScene(const std::filesystem::path& file) const {
  Scene scene = session_.document().scene;
  scene.camera = session_.camera;
  writeScene(file, scene);
}

}  // namespace sunfleck::view
