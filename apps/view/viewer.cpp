#include "apps/view/viewer.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <thread>

#include "core/require.hpp"
#include "render/image_file.hpp"
#include "render/scene_images.hpp"
#include "render/scene_writer.hpp"
#include "render/stand_field.hpp"

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
      renderer_(*context_, [this](const LeafOptics& leaf) { return session_.exactTables().of(leaf); }),
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
    return session_.upToDate() && !session_.work().busy && synthetic_.empty() && !hasTasks();
  return session_.upToDate() && !session_.work().busy && a_.done(session_.look.samples) && a_.key() == keyOf(model_) &&
         b_is_drawn && synthetic_.empty() && !hasTasks();
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
  return ((!session_.upToDate() && session_.work().busy) || session_.hasTasks()) &&
         (stand_ == 0 || (!exr_ && a_.done(session_.look.samples) && a_.key() == keyOf(model_)));
}

void Viewer::takeResult() {
  session_.advance();
  if (exr_) return;  // all of it shows the same stand
  const auto result = session_.take();
  if (!result) return;
  const Elapsed sending;
  try {
    gl::DrawnStand stand = gl::drawnStand(result->made.scene, *result->geometry);
    for (std::size_t kind = 0; kind < stand.kinds.size(); ++kind) stand.kinds[kind].levels = result->levels[kind];
    const gl::Sent sent = renderer_.update(stand);
    report_.sent_bytes = sent.all();
    field_ = result->geometry->field() ? result->geometry->field()->revision() : 0;
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
  drawExr();
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
  const bool ended = options_.ends && next_step_ == options_.script.size() && frames_left_ == 0 && synthetic_.empty();
  if (ended) requireNoFailure();
  return !ended || hasTasks();
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
          .stand = stand_,
          .field = model == Model::field ? field_ : 0};
}

// The last whole picture stays while the next stand is computed.
bool Viewer::drawPictures() {
  if (stand_ == 0) return false;
  const Look& look = session_.look;
  renderer_.timePasses(panels_.shown && panels_.right == Tab::times);  // it waits for each pass
  endStaleReference();
  if (session_.drawable(session_.document().model)) model_ = session_.document().model;
  bool drew = a_.draw(renderer_, keyOf(model_), look.samples);
  const bool compares = look.comparison != Comparison::off || flipped_;
  const bool draws_b = compares && look.other && session_.drawable(*look.other);
  if (draws_b) drew |= b_.draw(renderer_, keyOf(*look.other), look.samples);
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
  if (draws_b) b = shown(b_);
  if (compares && !look.other) b = referenceShown();
  if (look.comparison != Comparison::off) compare();
  Look now = look;
  if (flipped_) now.comparison = look.comparison == Comparison::flip ? Comparison::off : Comparison::flip;
  compositor_.draw(picture_, shown(a_), b, now, std::max(report_.difference_scale, 1e-6f));
  return drew;
}

void Viewer::serve(Requests& requests) {
  if (!session_.loaded()) return;
  const auto save = [&](std::optional<std::filesystem::path>& file, auto&& saves) {
    if (file) session_.attempt([&] { saves(*file); });
    file.reset();
  };
  save(requests.screenshot, [&](const auto& file) { savePng(file, picture_); });
  save(requests.exr, [&](const auto& file) { beginExr(file); });
  save(requests.scene, [&](const auto& file) { saveScene(file); });
  if (std::exchange(requests.cancel, false)) {
    session_.cancel();
    exr_.reset();
  }
}

void Viewer::savePng(const std::filesystem::path& file, const Canvas& canvas) {
  requirePictureName(file);
  if (file.extension() != ".png") throw InvalidInput(file.string() + ": must end in .png");
  requireNoImageOf(session_.document().scene, file);
  session_.write(file,
                 [file, size = canvas.size(), colours = canvas.read()] { writePng(file, size.x, size.y, colours); });
}

void Viewer::beginExr(const std::filesystem::path& file) {
  if (file.extension() != ".exr") throw InvalidInput(file.string() + ": must end in .exr");
  requirePictureName(file);
  requireNoImageOf(session_.document().scene, file);
  if (exr_) throw InvalidInput(file.string() + ": must wait until " + exr_->file.string() + " is drawn");
  if (stand_ == 0) throw InvalidInput(file.string() + ": must wait until there is a picture");
  gl::PictureEffort effort{.model = model_, .samples = session_.look.samples, .layers = {}, .exact = {}};
  effort.layers.assign(gl::kLayersBesideTotal.begin(), gl::kLayersBesideTotal.end());
  exr_.emplace(Exr{file, gl::PictureByFrames(*context_, renderer_, session_.camera, effort)});
}

// One frame in each of the window's.
void Viewer::drawExr() {
  report_.exr_done.reset();
  if (!exr_) return;
  if (!exr_->picture.complete()) exr_->picture.drawFrame();
  report_.exr_done = exr_->picture.done();
  if (!exr_->picture.complete()) return;
  session_.write(exr_->file,
                 [file = exr_->file, image = exr_->picture.take()] { writeImage(file, image, Display(1.f)); });
  exr_.reset();
}

namespace {

// Within what scene files hold, with the same proportions.
Camera asScenesHold(Camera camera) {
  constexpr int kLongest = 8192;
  const int longest = std::max(camera.width, camera.height);
  if (longest <= kLongest) return camera;
  for (int* side : {&camera.width, &camera.height})
    *side = std::max(1, static_cast<int>(std::int64_t{*side} * kLongest / longest));
  return camera;
}

}  // namespace

void Viewer::saveScene(const std::filesystem::path& file) {
  Scene scene = session_.document().scene;
  scene.camera = asScenesHold(session_.camera);
  for (SavedCamera& saved : scene.saved_cameras) saved.camera = asScenesHold(saved.camera);
  session_.write(file, [file, scene] { writeScene(file, scene); });
}

}  // namespace sunfleck::view
