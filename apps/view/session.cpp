#include "apps/view/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <utility>

#include "core/random.hpp"
#include "core/require.hpp"
#include "render/leaf_texture_file.hpp"
#include "render/scene_file.hpp"
#include "render/stand_field.hpp"
#include "sky/solar_position.hpp"

namespace sunfleck::view {

namespace {

TreeKind readKind(const std::string& species_or_file, std::uint64_t seed) {
  if (std::filesystem::path(species_or_file).has_extension()) return readScene(species_or_file).kinds.front();
  return grownKind(species_or_file, seed);
}

// Counts and times of products, by their names.
void add(std::vector<ProductCost>& sums, const std::vector<ProductCost>& costs) {
  for (const ProductCost& cost : costs) {
    const auto known = std::ranges::find(sums, cost.name, &ProductCost::name);
    if (known == sums.end()) {
      sums.push_back(cost);
      continue;
    }
    known->made += cost.made;
    known->adjusted += cost.adjusted;
    known->reused += cost.reused;
    known->seconds += cost.seconds;
  }
}

std::string textOf(const StandField& field) {
  if (field.by() == FieldBy::cells) return "preview on cells";
  const FieldResult& result = field.result();
  return fmt::format("field: {} iterations, {} {:.2g} %", result.iterations,
                     result.converged ? "error below" : "not steady yet, error up to", 100. * result.error_bound);
}

}  // namespace

std::string nameOf(Layer layer) {
  switch (layer) {
    case Layer::total:
      return "total";
    case Layer::direct:
      return "direct";
    case Layer::single:
      return "single";
    case Layer::multiple:
      return "multiple";
    case Layer::sky:
      return "sky";
    case Layer::depth:
      return "depth";
    case Layer::thickness:
      return "thickness";
    case Layer::compensation:
      return "g";
  }
  return {};
}

std::string nameOf(ToneCurve tone) {
  return tone == ToneCurve::filmic ? "filmic" : "clamp";
}

Session::Session(std::string name, std::function<Document()> read)
    : read_(std::make_shared<std::optional<Document>>()) {
  worker_.run("reading " + name, [read = std::move(read), into = read_] { *into = read(); });
}

ModelNeeds Session::needs() const {
  const auto draws = [&](Model model) { return document().model == model || look.other == model; };
  return {.exact = draws(Model::pp), .field = draws(Model::field)};
}

void Session::write(const std::filesystem::path& file, std::function<void()> writing) {
  writings_.push_back({file, std::async(std::launch::async, std::move(writing))});
}

std::optional<std::string> Session::writes() const {
  return writings_.empty() ? std::nullopt : std::optional("writing " + writings_.front().file.string());
}

void Session::endWritings() {
  for (std::size_t i = 0; i < writings_.size();) {
    if (writings_[i].ended.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
      ++i;
      continue;
    }
    Writing writing = std::move(writings_[i]);
    writings_.erase(writings_.begin() + static_cast<std::ptrdiff_t>(i));
    attempt([&] {
      writing.ended.get();
      say("wrote " + writing.file.string());
    });
  }
}

void Session::advance() {
  endWritings();
  if (const std::exception_ptr failure = worker_.failure()) {
    if (!loaded()) std::rethrow_exception(failure);
    attempt([&] { std::rethrow_exception(failure); });
    shown_ = wished_;  // what is drawn stays until the next change
    answered_needs_ = wished_needs_;
  }
  const bool working = worker_.state().busy;
  if (!loaded()) {
    if (working || !*read_) return;
    history_.emplace(std::move(**read_));
    read_.reset();
    camera = cameraOf(document().scene);
  }
  if (!prepared_.empty() && !worker_.state().busy)  // all have ended, with an edit or without
    for (const auto& made : std::exchange(prepared_, {}))
      if (*made) attempt([&] { edit(**made); });
  if (const std::uint64_t stand = history_->stand() + 1; wished_ != stand || !wished_needs_.hold(needs())) {
    wished_ = stand;
    answered_needs_ = {};
    wished_needs_ = needs();
    worker_.wish({.scene = document().scene,
                  .needs = {.field = wished_needs_.field},
                  .effort = document().effort,
                  .exact = wished_needs_.exact,
                  .revision = wished_});
  }
}

void Session::edit(const SceneEdit& edit, std::uint64_t gesture) {
  history_->apply(edit, gesture);
  say("changed: " + nameOf(edit));
}

void Session::undo() {
  const auto what = history_->undoes();
  say(history_->undo() ? "undone: " + *what : "there is nothing to undo");
}

void Session::redo() {
  const auto what = history_->redoes();
  say(history_->redo() ? "done again: " + *what : "there is nothing to do again");
}

void Session::select(std::optional<std::size_t> tree) {
  history_->select(tree);
  if (!tree) return;
  const Scene& scene = document().scene;
  const Placement& placement = scene.stand.trees[*tree];
  say(fmt::format("tree {} ({}) at {:.2f}, {:.2f} m", *tree + 1, scene.kindOf(placement).name, placement.position.x,
                  placement.position.y));
}

void Session::attempt(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception& e) {
    say(e.what(), true);
  }
}

namespace {

std::size_t selectedTree(const Document& document) {
  if (!document.selected) throw InvalidInput("no tree is selected");
  return *document.selected;
}

}  // namespace

void Session::moveSelected(glm::vec2 by, std::uint64_t gesture) {
  const std::size_t tree = selectedTree(document());
  edit(MoveTree{tree, document().scene.stand.trees[tree].position + glm::vec3(by, 0.f)}, gesture);
}

void Session::turnSelected(float by, std::uint64_t gesture) {
  const std::size_t tree = selectedTree(document());
  edit(TurnTree{tree, document().scene.stand.trees[tree].rotation + by}, gesture);
}

void Session::addTree(glm::vec2 place, std::uint32_t kind) {
  edit(AddTrees{{Placement{.position = {place, groundHeight()}, .kind = kind}}});
}

void Session::copySelected(glm::vec2 by) {
  Placement copy = document().scene.stand.trees[selectedTree(document())];
  copy.position += glm::vec3(by, 0.f);
  edit(AddTrees{{copy}});
}

void Session::removeSelected() {
  edit(RemoveTrees{{selectedTree(document())}});
}

void Session::paint(glm::vec2 place, float radius, float spacing, std::uint32_t kind, std::uint64_t gesture) {
  constexpr int kTrials = 60;
  Random random(++strokes_, 0);  // the same strokes paint the same trees
  std::vector<Placement> painted;
  const auto isFree = [&](const glm::vec2& at) {
    const auto far = [&](const Placement& tree) { return glm::distance(glm::vec2(tree.position), at) >= spacing; };
    return std::ranges::all_of(document().scene.stand.trees, far) && std::ranges::all_of(painted, far);
  };
  for (int trial = 0; trial < kTrials; ++trial) {
    const float angle = 6.2831853f * random.uniform(), away = radius * std::sqrt(random.uniform());
    const glm::vec2 at = place + away * glm::vec2(std::cos(angle), std::sin(angle));
    if (isFree(at)) painted.push_back({.position = {at, groundHeight()}, .kind = kind});
  }
  if (!painted.empty()) edit(AddTrees{painted}, gesture);
}

void Session::turnSunByDate(std::size_t sun, const std::string& date, const std::string& time, double latitude,
                            double longitude) {
  const SolarPosition at = solarPosition(utcMoment(date, time), glm::radians(latitude), glm::radians(longitude));
  std::vector<Sun> suns = document().scene.suns;
  require(sun < suns.size(), "sun", sun + 1, "one of the scene's suns");
  suns[sun].zenith = static_cast<float>(at.zenith);
  suns[sun].azimuth = static_cast<float>(at.azimuth);
  edit(SetSuns{suns});
}

void Session::prepare(const std::string& what, std::function<SceneEdit()> make) {
  const auto into = std::make_shared<std::optional<SceneEdit>>();
  prepared_.push_back(into);
  worker_.run(what, [into, make = std::move(make)] { *into = make(); });
}

void Session::addKind(const std::string& species_or_file, std::uint64_t seed) {
  const Bounds stand = bounds(document().scene);
  prepare("growing " + species_or_file, [=, ground = groundHeight()] {
    const TreeKind kind = readKind(species_or_file, seed);
    glm::vec2 place(0.f);
    if (const Bounds tree = bounds(*kind.mesh); !stand.empty() && !tree.empty())
      place = {stand.high.x - tree.low.x, stand.centre().y - tree.centre().y};
    return AddKind{kind, {place, ground}};
  });
}

void Session::setSkyImage(const std::string& file, float rotation) {
  SceneSky sky = document().scene.sky;
  if (sky.kind != SceneSky::Kind::image)
    sky = {.kind = SceneSky::Kind::image, .irradiance = glm::dvec3(kSkyIrradiance)};
  sky.file = file;
  sky.rotation = rotation;
  prepare("reading " + file, [sky]() mutable {
    readSkyImage(sky);
    return SetSky{sky};
  });
}

void Session::setLeafImage(std::size_t kind, LeafImage image, const std::string& file) {
  const bool gloss = image == LeafImage::upper_gloss || image == LeafImage::lower_gloss;
  prepare("reading " + file, [=] {
    return SetLeafImage{kind, image, readLeafTexture(file, gloss ? 1.f : kMostLeafAlbedo)};
  });
}

std::uint32_t Session::selectedKind() const {
  return document().selected ? document().scene.stand.trees[*document().selected].kind : 0;
}

float Session::groundHeight() const {
  const Scene& scene = document().scene;
  float lowest = scene.stand.trees.empty() ? 0.f : scene.stand.trees.front().position.z;
  for (const Placement& tree : scene.stand.trees) lowest = std::min(lowest, tree.position.z);
  return lowest;
}

void Session::fit(glm::ivec2 size) {
  const auto aspect = [](float width, float height) { return width / height; };
  if (loaded() && !fitted_) {
    const float wider = aspect(static_cast<float>(size.x), static_cast<float>(size.y)) /
                        aspect(static_cast<float>(camera.width), static_cast<float>(camera.height));
    camera.width = size.x;
    camera.height = size.y;
    if (!document().scene.camera)
      camera = showingAll(document().scene, camera);
    else
      camera.half_width *= std::max(wider, 1.f);
    fitted_ = true;
  }
  camera.width = size.x;
  camera.height = size.y;
}

void Session::showWholeStand() {
  camera = showingAll(document().scene, camera);
}

void Session::goTo(const std::string& saved_camera) {
  const Camera& found = savedCamera(document().scene, saved_camera);
  const int width = camera.width, height = camera.height;
  camera = found;
  camera.width = width;
  camera.height = height;
}

void Session::release(const StandWorker::Result& shown) {
  const StandWish& made = shown.made;
  shown_ = made.revision;
  shown_scene_ = std::make_shared<const Scene>(made.scene);
  shown_needs_ = {.exact = made.exact, .field = made.needs.field};
  answered_needs_ = {.exact = made.exact, .field = made.needs.field && !made.needs.preview};
  field_text_ = made.needs.field ? textOf(*shown.geometry->field()) : "";
  if (made.previewed) {  // what a preview began
    add(last_costs_, shown.costs);
    last_seconds_ += shown.seconds;
  } else {
    last_costs_ = shown.costs;
    last_seconds_ = shown.seconds;
    prepares_ = shown.from_nothing;
  }
  if (prepares_) prepared_seconds_ = last_seconds_;
  add(recomputed_, shown.costs);
  worker_.release();
}

bool Session::upToDate() const {
  return loaded() && prepared_.empty() && shown_ == history_->stand() + 1 && answered_needs_.hold(needs());
}

std::string Session::lastCostText() const {
  std::string anew;
  for (const ProductCost& cost : last_costs_)
    if (const std::size_t count = cost.made + cost.adjusted; count > 0)
      anew += fmt::format("{}{} {}", anew.empty() ? "" : ", ", count, cost.name);
  const double share = prepared_seconds_ > 0. ? last_seconds_ / prepared_seconds_ : 0.;
  return fmt::format("{:.1f} ms, {:.1f} % of the {:.1f} ms that preparing all took: {}", 1e3 * last_seconds_,
                     100. * share, 1e3 * prepared_seconds_, anew.empty() ? "nothing" : anew);
}

void Session::cancel() {
  worker_.cancel();
  prepared_.clear();
  if (loaded()) shown_ = wished_;  // what is drawn stays until the next change
  answered_needs_ = wished_needs_;
  say("cancelled");
}

void Session::say(std::string message, bool error) {
  message_ = std::move(message);
  message_is_error_ = error;
}

}  // namespace sunfleck::view
