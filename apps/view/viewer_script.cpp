#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/trigonometric.hpp>
#include <iterator>
#include <map>
#include <stdexcept>

#include "apps/view/viewer.hpp"
#include "core/require.hpp"

namespace sunfleck::view {
namespace {

constexpr int kDragSteps = 8;

float radians(double degrees) {
  return glm::radians(static_cast<float>(degrees));
}

float number(const ScriptStep& step, std::size_t i) {
  return static_cast<float>(step.numbers.at(i));
}

float number(const ScriptStep& step, std::size_t i, float otherwise) {
  return i < step.numbers.size() ? number(step, i) : otherwise;
}

int whole(const ScriptStep& step, std::size_t i, int otherwise) {
  return i < step.numbers.size() ? static_cast<int>(step.numbers[i]) : otherwise;
}

template <typename Value, std::size_t n, typename Name>
Value named(const std::string& name, const std::array<Value, n>& values, const std::string& what,
            const Name& nameOfValue) {
  std::string names;
  for (const Value& value : values) {
    if (nameOfValue(value) == name) return value;
    names += (names.empty() ? "" : ", ") + nameOfValue(value);
  }
  throw InvalidInput(fmt::format("{} = \"{}\": must be one of {}", what, name, names));
}

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

int keyNamed(const std::string& name) {
  static const std::map<std::string, int> kNames{{"delete", kDelete}, {"space", ' '},    {"escape", kEscape},
                                                 {"tab", kTab},       {"enter", kEnter}, {"backspace", kBackspace}};
  if (const auto found = kNames.find(name); found != kNames.end()) return found->second;
  if (name.size() == 1 && std::isalnum(static_cast<unsigned char>(name[0])))
    return std::toupper(static_cast<unsigned char>(name[0]));
  throw InvalidInput("key = \"" + name + "\": must be a letter, or delete, space, escape, tab, enter, backspace");
}

std::string bytesOf(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InvalidInput(file + ": cannot be read");
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

void Viewer::advanceScript() {
  while (next_step_ < options_.script.size() && frames_left_ == 0 && synthetic_.empty()) {
    requireNoFailure();
    const ScriptStep& step = options_.script[next_step_];
    if (!session_.loaded() || (hasTasks() && step.verb != Verb::cancel)) return;
    const auto where = [&](const char* what) {
      return fmt::format("{}:{}: {}", options_.script_name, step.line, what);
    };
    try {
      if (blocked(step)) return;
      execute(step);
      still_frames_ = 0;
    } catch (const InvalidInput& e) {
      throw InvalidInput(where(e.what()));
    } catch (const std::exception& e) {
      throw std::runtime_error(where(e.what()));
    }
    ++next_step_;
  }
}

bool Viewer::hasTasks() const {
  return exr_ || session_.hasTasks();
}

// What went wrong after a step was done, in the background or by the mouse, is that step's failure.
void Viewer::requireNoFailure() const {
  if (next_step_ > 0 && session_.messageIsError())
    throw InvalidInput(
        fmt::format("{}:{}: {}", options_.script_name, options_.script[next_step_ - 1].line, session_.message()));
}

bool Viewer::blocked(const ScriptStep& step) {
  switch (step.verb) {
    // What looks at the picture needs one of what the lines before made.
    case Verb::pick:
    case Verb::probe:
    case Verb::exr:
    case Verb::cost:
    case Verb::wait_ready:
    case Verb::window_screenshot:
    case Verb::expect_recomputed:
      return !settled();
    case Verb::wait_preview:
      if (!session_.needsField()) throw InvalidInput("wait preview: must follow model field");
      return !session_.showsField() || !a_.done(1) || !(a_.key() == keyOf(model_));
    case Verb::wait_reference:
      if (session_.look.comparison == Comparison::off || session_.look.other)
        throw InvalidInput("wait reference: must follow compare with reference, and wipe, flip or difference");
      if (!report_.reference_failure.empty()) throw std::runtime_error(report_.reference_failure);
      session_.look.reference_noise = step.numbers[0];
      return !settled() || !report_.reference_finished || !report_.error;
    default:
      return false;
  }
}

void Viewer::execute(const ScriptStep& step) {
  if (step.verb <= Verb::cells || (step.verb >= Verb::select && step.verb <= Verb::kind) || step.verb == Verb::undo ||
      step.verb == Verb::redo)
    executeEdit(step);
  else if (step.verb >= Verb::mouse && step.verb <= Verb::restore)
    executeInput(step);
  else if (step.verb >= Verb::expect_recomputed)
    expect(step);
  else
    executeLook(step);
}

void Viewer::executeEdit(const ScriptStep& step) {
  const Scene& scene = session_.document().scene;
  const std::uint32_t kind = session_.selectedKind();
  const auto sun = [&](Sun of) {
    of.zenith = radians(step.numbers[0]);
    of.azimuth = radians(step.numbers[1]);
    if (step.numbers.size() > 2) of.irradiance = glm::vec3(number(step, 2));
    return of;
  };
  const auto setEffort = [&](int GeometryEffort::*member) {
    GeometryEffort effort = session_.document().effort;
    effort.*member = whole(step, 0, 0);
    session_.edit(SetEffort{effort});
  };
  BandOptics leaf = scene.kinds[kind].told();
  const auto setLeaf = [&](const LeafDescription& told) {
    session_.edit(SetOptics{kind, leaf, scene.kinds[kind].wood_reflectance, told});
  };
  const auto named_band = [&](std::size_t band) {
    return step.texts[0] == "all" || step.texts[0] == std::array{"red", "green", "blue"}[band];
  };
  switch (step.verb) {
    case Verb::sun: {
      std::vector<Sun> suns = scene.suns;
      suns[0] = sun(suns[0]);
      return session_.edit(SetSuns{suns});
    }
    case Verb::add_sun: {
      std::vector<Sun> suns = scene.suns;
      suns.push_back(sun({}));
      return session_.edit(SetSuns{suns});
    }
    case Verb::sun_at:
      return session_.turnSunByDate(0, step.texts[0], step.texts[1], step.numbers[0], step.numbers[1]);
    case Verb::sky: {
      using Kind = SceneSky::Kind;
      static const std::map<std::string, Kind> kKinds{
          {"none", Kind::none}, {"uniform", Kind::uniform}, {"overcast", Kind::overcast}, {"preetham", Kind::preetham}};
      SceneSky sky{.kind = kKinds.at(step.texts[0])};
      if (!step.numbers.empty() || sky.kind == Kind::uniform || sky.kind == Kind::overcast)
        sky.irradiance = glm::dvec3(step.numbers.empty() ? kSkyIrradiance : step.numbers[0]);
      return session_.edit(SetSky{sky});
    }
    case Verb::sky_image:
      return session_.setSkyImage(step.texts[0], step.numbers.empty() ? 0.f : radians(step.numbers[0]));
    case Verb::ground:
      return session_.edit(SetGround{
          {number(step, 0), number(step, 1, number(step, 0)), number(step, 2, number(step, 1, number(step, 0)))}});
    case Verb::leaf_albedo:
      for (LeafOptics& band : leaf) band.reflectance = band.transmittance = 0.5f * number(step, 0);
      return setLeaf(LeafByNumbers{});
    case Verb::leaf_species:
      return setLeaf(leafOfSpecies(step.texts[0]));
    case Verb::leaf_prospect: {
      const auto* has = std::get_if<LeafByContents>(&scene.kinds[kind].description);
      LeafByContents told = has ? *has : LeafByContents{};
      setContents(told.contents, std::array{std::pair(step.texts[0], step.numbers[0])}, "leaf prospect: ");
      return setLeaf(told);
    }
    case Verb::leaf_slab: {
      const auto* has = std::get_if<LeafByTissue>(&scene.kinds[kind].description);
      LeafByTissue told = has ? *has : LeafByTissue{};
      for (int band = 0; band < kBands; ++band)
        if (!has || named_band(static_cast<std::size_t>(band))) {
          told.absorption[band] = number(step, 0);
          told.scattering[band] = number(step, 1);
        }
      told.thickness = step.numbers[2];
      return setLeaf(told);
    }
    case Verb::leaf:
      for (std::size_t band = 0; band < kBands; ++band)
        if (named_band(band)) {
          leaf[band].reflectance = number(step, 0);
          leaf[band].transmittance = number(step, 1);
        }
      return setLeaf(LeafByNumbers{});
    case Verb::gloss:
      for (LeafOptics& band : leaf) {
        band.gloss = number(step, 0);
        band.gloss_roughness = number(step, 1, band.gloss_roughness);
      }
      return setLeaf(scene.kinds[kind].description);
    case Verb::model:
      return session_.edit(SetModel{named(step.texts[0], kModels, "model", [](Model m) { return nameOf(m); })});
    case Verb::directions:
      return setEffort(&GeometryEffort::sample_directions);
    case Verb::map:
      return setEffort(&GeometryEffort::light_resolution);
    case Verb::cells:
      return setEffort(&GeometryEffort::cells);
    case Verb::select:
      return session_.select(static_cast<std::size_t>(step.numbers[0]) - 1);
    case Verb::select_none:
      return session_.select(std::nullopt);
    case Verb::pick:
      return session_.select(probeAt({number(step, 0), number(step, 1)}).tree);
    case Verb::move:
      return session_.moveSelected({number(step, 0), number(step, 1)});
    case Verb::turn:
      return session_.turnSelected(radians(step.numbers[0]));
    case Verb::add: {
      std::uint32_t of = kind;
      if (!step.texts.empty()) {
        const auto found = std::ranges::find(scene.kinds, step.texts[0], &TreeKind::name);
        if (found == scene.kinds.end())
          throw InvalidInput("kind \"" + step.texts[0] + "\": must be one of the scene's");
        of = static_cast<std::uint32_t>(found - scene.kinds.begin());
      }
      return session_.addTree({number(step, 0), number(step, 1)}, of);
    }
    case Verb::copy:
      return session_.copySelected({number(step, 0), number(step, 1)});
    case Verb::erase:
      return session_.removeSelected();
    case Verb::paint:
      return session_.paint({number(step, 0), number(step, 1)}, number(step, 2), number(step, 3), kind);
    case Verb::kind:
      return session_.addKind(step.texts[0], static_cast<std::uint64_t>(whole(step, 0, 1)));
    case Verb::undo:
    case Verb::redo:
      for (int i = 0; i < whole(step, 0, 1); ++i) step.verb == Verb::undo ? session_.undo() : session_.redo();
      return;
    default:
      throw std::logic_error("no edit");
  }
}

void Viewer::executeLook(const ScriptStep& step) {
  Camera& camera = session_.camera;
  Look& look = session_.look;
  switch (step.verb) {
    case Verb::samples:
      look.samples = whole(step, 0, 1);
      break;
    case Verb::detail:
      look.fewer_leaves = step.texts[0] == "fewer";
      break;
    case Verb::camera_orbit:
      camera.azimuth = radians(step.numbers[0]);
      camera.elevation = radians(step.numbers[1]);
      look.navigation = Navigation::orbit;
      break;
    case Verb::camera_fly:
      camera = flown(camera, number(step, 0), number(step, 1), number(step, 2));
      look.navigation = Navigation::fly;
      break;
    case Verb::camera_walk:
      camera = walked(camera, number(step, 0), number(step, 1), session_.groundHeight());
      look.navigation = Navigation::walk;
      break;
    case Verb::camera_look:
      camera = lookedAround(camera, radians(step.numbers[0]), radians(step.numbers[1]));
      break;
    case Verb::camera_zoom:
      camera = zoomed(camera, number(step, 0), 0.5f * glm::vec2(camera.width, camera.height));
      break;
    case Verb::camera_pan:
      camera = panned(camera, {number(step, 0), number(step, 1)});
      break;
    case Verb::camera_whole:
      session_.showWholeStand();
      break;
    case Verb::field_of_view:
      camera = inPerspective(camera, radians(step.numbers[0]));
      break;
    case Verb::camera_save:
      session_.edit(SaveCamera{{step.texts[0], camera}});
      break;
    case Verb::camera_load:
      session_.goTo(step.texts[0]);
      break;
    case Verb::exposure:
      look.display.exposure = number(step, 0);
      break;
    case Verb::tone:
      look.display.curve = named(step.texts[0], kTones, "tone", [](ToneCurve t) { return nameOf(t); });
      break;
    case Verb::layer:
      look.layer = named(step.texts[0], kLayers, "layer", [](Layer l) { return nameOf(l); });
      break;
    case Verb::compare_off:
      look.comparison = Comparison::off;
      break;
    case Verb::compare_with:
      look.other.reset();
      if (step.texts[0] != "reference")
        look.other = named(step.texts[0], kModels, "model", [](Model m) { return nameOf(m); });
      break;
    case Verb::compare_wipe:
      look.comparison = Comparison::wipe;
      look.wipe = number(step, 0);
      break;
    case Verb::compare_flip:
      look.comparison = Comparison::flip;
      break;
    case Verb::compare_difference:
      look.comparison = Comparison::difference;
      look.difference_scale = number(step, 0, 0.f);
      break;
    case Verb::probe: {
      report_.probe = probeAt({number(step, 0), number(step, 1)});
      const Probe& p = *report_.probe;
      fmt::print(
          "{} {}: {}, radiance {:.6g} {:.6g} {:.6g}{}\n", p.pixel.x, p.pixel.y, p.what, p.radiance.x, p.radiance.y,
          p.radiance.z,
          p.depth ? fmt::format(", depth {:.4g}, thickness {:.4g}, G {:.4g}", *p.depth, *p.thickness, *p.compensation)
                  : "");
      break;
    }
    case Verb::cost:
      fmt::print("{}; to the graphics card {:.1f} ms, {:.2f} MB\n", session_.lastCostText(), report_.sent_ms,
                 1e-6 * static_cast<double>(report_.sent_bytes));
      break;
    case Verb::panels:
      panels_.shown = step.texts[0] == "on";
      break;
    case Verb::tab:
      panels_.show(named(step.texts[0], kTabs, "tab", [](Tab t) { return lower(nameOf(t)); }));
      break;
    case Verb::frames:
      frames_left_ = whole(step, 0, 1);
      break;
    case Verb::wait_ready:
    case Verb::wait_preview:
    case Verb::wait_reference:
      break;
    case Verb::cancel:
      requests_.cancel = true;
      frames_left_ = 1;  // in which it is done
      break;
    case Verb::screenshot:
      savePng(step.texts[0], picture_);
      break;
    case Verb::window_screenshot:
      savePng(step.texts[0], canvas_);
      break;
    case Verb::exr:
      beginExr(step.texts[0]);
      break;
    case Verb::save:
      saveScene(step.texts[0]);
      break;
    default:
      throw std::logic_error("no look");
  }
}

void Viewer::executeInput(const ScriptStep& step) {
  Input now = scripted_;
  now.held.assign(kKeys, false);
  now.pressed.clear();
  now.wheel = 0.f;
  switch (step.verb) {
    case Verb::mouse:
      now.mouse = {number(step, 0), number(step, 1)};
      break;
    case Verb::drag: {
      const glm::vec2 from(number(step, 0), number(step, 1)), to(number(step, 2), number(step, 3));
      const std::string button = step.texts.empty() ? "left" : step.texts[0];
      const int which = button == "left" ? 0 : button == "right" ? 1 : 2;
      now.mouse = from;
      synthetic_.push_back(now);  // it comes to rest there first
      now.buttons[which] = true;
      for (int i = 0; i <= kDragSteps; ++i) {
        now.mouse = from + (to - from) * (static_cast<float>(i) / kDragSteps);
        synthetic_.push_back(now);
      }
      now.buttons[which] = false;
      break;
    }
    case Verb::wheel:
      now.wheel = number(step, 0);
      break;
    case Verb::press: {
      const int key = keyNamed(step.texts[0]);
      Input pressed = now;
      pressed.held[static_cast<std::size_t>(key)] = true;
      pressed.pressed.push_back(key);
      synthetic_.push_back(pressed);
      break;
    }
    case Verb::resize:
      window_->resize({whole(step, 0, 1), whole(step, 1, 1)});
      frames_left_ = 2;  // until the window has it
      return;
    case Verb::minimise:
      window_->minimise();
      frames_left_ = 2;
      return;
    case Verb::restore:
      window_->restore();
      frames_left_ = 2;
      return;
    default:
      throw std::logic_error("no input");
  }
  synthetic_.push_back(now);
}

void Viewer::expect(const ScriptStep& step) {
  const auto fail = [](const std::string& what) { throw std::runtime_error("expected " + what); };
  switch (step.verb) {
    case Verb::expect_recomputed: {
      const std::string name = step.texts[0];
      std::size_t found = 0;
      bool known = name == "none";
      std::string names, anew;
      for (const ProductCost& cost : session_.recomputed()) {
        std::string of = cost.name;
        std::ranges::replace(of, ' ', '_');
        names += (names.empty() ? "" : ", ") + of;
        const std::size_t count = cost.made + cost.adjusted;
        if (count > 0) anew += fmt::format("{}{} {}", anew.empty() ? "" : ", ", count, cost.name);
        if (of == name) known = true;
        if (of == name || name == "none") found += count;
      }
      session_.clearRecomputed();
      if (!known && !session_.lastCosts().empty())
        if (std::ranges::none_of(session_.lastCosts(), [&](const ProductCost& c) {
              std::string of = c.name;
              std::ranges::replace(of, ' ', '_');
              return of == name;
            }))
          throw InvalidInput(fmt::format("product \"{}\": must be none or one of {}", name, names));
      const bool met = name == "none"         ? found == 0
                       : step.numbers.empty() ? found > 0
                                              : found == static_cast<std::size_t>(step.numbers[0]);
      if (!met)
        fail(fmt::format("to recompute {} {}, but recomputed: {}", name,
                         step.numbers.empty() ? "" : fmt::format("{}", step.numbers[0]),
                         anew.empty() ? "nothing" : anew));
      return;
    }
    case Verb::expect_trees:
      if (const std::size_t trees = session_.document().scene.stand.trees.size();
          trees != static_cast<std::size_t>(step.numbers[0]))
        fail(fmt::format("{} trees, but there are {}", step.numbers[0], trees));
      return;
    case Verb::expect_selected: {
      const auto selected = session_.document().selected;
      const std::size_t number = selected ? *selected + 1 : 0;
      if (number != static_cast<std::size_t>(step.numbers[0]))
        fail(fmt::format("tree {} to be selected, but it is {}", step.numbers[0], number));
      return;
    }
    case Verb::expect_same:
      if (bytesOf(step.texts[0]) != bytesOf(step.texts[1]))
        fail(fmt::format("{} and {} to be the same", step.texts[0], step.texts[1]));
      return;
    case Verb::expect_noise:
      if (!(report_.reference_noise <= step.numbers[0]))
        fail(fmt::format("noise of at most {}, but it is {}", step.numbers[0], report_.reference_noise));
      return;
    default:
      throw std::logic_error("no expectation");
  }
}

}  // namespace sunfleck::view
