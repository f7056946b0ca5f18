#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "apps/view/viewer.hpp"

namespace sunfleck::view {
namespace {

constexpr float kTurn = 0.006f;          // of the camera by a pixel [rad]
constexpr float kWheelStep = 0.88f;      // factor of half the picture's width by one step
constexpr float kStepsPerSecond = 0.4f;  // of the camera by a key, in half widths of the picture
constexpr float kWalk = 2.f;             // [m/s]
constexpr float kGripOfWipe = 8.f;       // [pixel]
constexpr float kClick = 3.f;            // [pixel] that a click may move

bool holds(const Input& input, int key) {
  return input.held[static_cast<std::size_t>(key)];
}

}  // namespace

void Viewer::act(const Input& input) {
  const glm::vec2 place = input.mouse - glm::vec2(corner_);
  const glm::vec2 by = before_.size == input.size ? input.mouse - before_.mouse : glm::vec2(0.f);
  rested_ = by == glm::vec2(0.f) ? rested_ + 1 : 0;
  if (!gui_.wantsKeys()) actByKeys(input);
  if (!gui_.wantsMouse() || drag_ != Drag::none) actByMouse(input, place, by);
  const bool within = place.x >= 0.f && place.y >= 0.f && place.x < static_cast<float>(session_.camera.width) &&
                      place.y < static_cast<float>(session_.camera.height) && !gui_.wantsMouse();
  constexpr int kRested = 2;
  if (within && panels_.right == Tab::probe && stand_ != 0 && rested_ >= kRested &&
      (probed_ != place || rested_ == kRested)) {
    probed_ = place;
    report_.probe = probeAt(place);
  }
}

void Viewer::beginDrag(const Input& input, glm::vec2 place) {
  const Look& look = session_.look;
  dragged_ = false;
  pressed_ = place;
  gesture_ = session_.newGesture();
  const float line = std::round(look.wipe * static_cast<float>(session_.camera.width));
  if (input.buttons[1] || input.buttons[2]) {
    drag_ = look.navigation == Navigation::orbit ? Drag::shift : Drag::turn;
  } else if (holds(input, 'L')) {
    drag_ = Drag::sun;
  } else if (look.comparison == Comparison::wipe && std::abs(place.x - line) < kGripOfWipe) {
    drag_ = Drag::wipe;
  } else if (panels_.tool == Tool::paint) {
    drag_ = Drag::paint;
  } else {
    drag_ = Drag::turn;
    const auto selected = session_.document().selected;
    if (panels_.tool != Tool::select || !selected || stand_ == 0) return;
    if (probeAt(place).tree != selected) return;
    const glm::vec3 tree = session_.document().scene.stand.trees[*selected].position;
    const auto ground = groundAt(session_.camera, place, tree.z);
    if (!ground) return;
    drag_ = Drag::tree;
    grip_ = glm::vec2(*ground) - glm::vec2(tree);
  }
}

void Viewer::actByMouse(const Input& input, glm::vec2 place, glm::vec2 by) {
  const bool held = input.buttons[0] || input.buttons[1] || input.buttons[2];
  const bool was_held = before_.buttons[0] || before_.buttons[1] || before_.buttons[2];
  Camera& camera = session_.camera;
  Look& look = session_.look;
  if (held && !was_held) beginDrag(input, place);
  if (!held && was_held && drag_ != Drag::none) {
    if (!dragged_ && before_.buttons[0]) click(place);
    drag_ = Drag::none;
  }
  if (input.wheel != 0.f) {
    if (look.navigation == Navigation::orbit)
      camera = zoomed(camera, std::pow(kWheelStep, input.wheel), place);
    else
      camera = flown(camera, 0.f, 0.f, 0.2f * camera.half_width * input.wheel);
  }
  if (drag_ == Drag::none || !held || (by == glm::vec2(0.f) && drag_ != Drag::paint)) return;
  if (!dragged_ && drag_ != Drag::paint && glm::distance(place, pressed_) <= kClick) return;
  dragged_ = true;
  switch (drag_) {
    case Drag::turn:
      camera = look.navigation == Navigation::orbit ? orbited(camera, -kTurn * by.x, kTurn * by.y)
                                                    : lookedAround(camera, -0.5f * kTurn * by.x, 0.5f * kTurn * by.y);
      break;
    case Drag::shift:
      camera = panned(camera, by);
      break;
    case Drag::wipe:
      look.wipe = std::clamp(place.x / static_cast<float>(camera.width), 0.f, 1.f);
      break;
    case Drag::sun: {
      std::vector<Sun> suns = session_.document().scene.suns;
      Sun& sun = suns[std::min(panels_.sun, suns.size() - 1)];
      sun.azimuth = std::remainder(sun.azimuth + kTurn * by.x, 6.2831853f);
      sun.zenith = std::clamp(sun.zenith + kTurn * by.y, 0.f, 3.14159f);
      session_.attempt([&] { session_.edit(SetSuns{suns}, gesture_); });
      break;
    }
    case Drag::tree: {
      const std::size_t tree = *session_.document().selected;
      const glm::vec3 from = session_.document().scene.stand.trees[tree].position;
      if (const auto ground = groundAt(camera, place, from.z))
        session_.attempt([&] { session_.edit(MoveTree{tree, {glm::vec2(*ground) - grip_, from.z}}, gesture_); });
      break;
    }
    case Drag::paint:
      if (const auto ground = groundAt(camera, place, session_.groundHeight()))
        session_.attempt([&] {
          session_.paint(glm::vec2(*ground), panels_.paint_radius, panels_.paint_spacing, panels_.kind, gesture_);
        });
      break;
    case Drag::none:
      break;
  }
}

void Viewer::click(glm::vec2 place) {
  if (stand_ == 0) return;
  session_.attempt([&] {
    const auto ground = groundAt(session_.camera, place, session_.groundHeight());
    if (panels_.tool == Tool::add && ground) session_.addTree(glm::vec2(*ground), panels_.kind);
    if (panels_.tool == Tool::select) session_.select(probeAt(place).tree);
  });
}

void Viewer::actByKeys(const Input& input) {
  for (const int key : input.pressed) {
    if (holds(input, kControl)) {
      if (key == 'Z') session_.undo();
      if (key == 'Y') session_.redo();
    } else if (key == kTab) {
      panels_.shown = !panels_.shown;
    } else if (key == kEscape) {
      session_.attempt([&] { session_.select(std::nullopt); });
    } else if (key == kDelete) {
      session_.attempt([&] { session_.removeSelected(); });
    } else if (key == 'F') {
      session_.showWholeStand();
    }
  }
  flipped_ = holds(input, ' ');
  move(input);
}

void Viewer::move(const Input& input) {
  const auto axis = [&](int more, int less) {
    return static_cast<float>(holds(input, more)) - static_cast<float>(holds(input, less));
  };
  const float right = axis('D', 'A'), ahead = axis('W', 'S'), up = axis('E', 'Q');
  if ((right == 0.f && ahead == 0.f && up == 0.f) || holds(input, kControl)) return;
  Camera& camera = session_.camera;
  const float seconds = std::min(ImGui::GetIO().DeltaTime, 0.2f);
  const float step = seconds * kStepsPerSecond * camera.half_width * (holds(input, kShift) ? 4.f : 1.f);
  if (session_.look.navigation == Navigation::walk) {
    const float pace = seconds * kWalk * (holds(input, kShift) ? 4.f : 1.f);
    camera = walked(camera, pace * right, pace * ahead, session_.groundHeight());
  } else if (session_.look.navigation == Navigation::fly) {
    camera = flown(camera, step * right, step * up, step * ahead);
  }
}

namespace {

ImVec2 onScreen(glm::vec2 pixel, glm::ivec2 corner) {
  return {pixel.x + static_cast<float>(corner.x), pixel.y + static_cast<float>(corner.y)};
}

}  // namespace

// Lines over the picture: the selected tree's foot, the brush, the wipe.
void Viewer::overlay() {
  if (!session_.loaded() || stand_ == 0) return;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const Camera& camera = session_.camera;
  const glm::ivec2 end = corner_ + glm::ivec2(camera.width, camera.height);
  list.PushClipRect(onScreen({0.f, 0.f}, corner_), {static_cast<float>(end.x), static_cast<float>(end.y)});
  const auto ring = [&](const glm::vec3& centre, float radius, ImU32 colour) {
    constexpr int kCorners = 48;
    std::optional<glm::vec2> last;
    for (int i = 0; i <= kCorners; ++i) {
      const float angle = 6.2831853f * static_cast<float>(i) / kCorners;
      const auto at = pixelOf(camera, centre + radius * glm::vec3(std::cos(angle), std::sin(angle), 0.f));
      if (last && at) list.AddLine(onScreen(*last, corner_), onScreen(*at, corner_), colour, 2.f);
      last = at;
    }
  };
  const Scene& scene = session_.document().scene;
  if (const auto selected = session_.document().selected) {
    const Placement& tree = scene.stand.trees[*selected];
    const Bounds box = bounds(*scene.kindOf(tree).mesh);
    const float radius = 0.5f * std::max(box.size().x, box.size().y);
    for (const float height : {box.low.z, box.high.z})
      ring(tree.position + glm::vec3(glm::vec2(box.centre()), height), radius, IM_COL32(255, 190, 70, 200));
  }
  if (panels_.tool == Tool::paint && !gui_.wantsMouse())
    if (const auto ground = groundAt(camera, input_.mouse - glm::vec2(corner_), session_.groundHeight()))
      ring(*ground, panels_.paint_radius, IM_COL32(150, 230, 130, 220));
  if (session_.look.comparison == Comparison::wipe) {
    const float x = std::round(session_.look.wipe * static_cast<float>(camera.width));
    list.AddLine(onScreen({x, 0.f}, corner_), onScreen({x, static_cast<float>(camera.height)}, corner_),
                 IM_COL32(255, 255, 255, 200), 2.f);
    const std::string a = nameOf(model_);
    const std::string b = session_.look.other ? nameOf(*session_.look.other) : "Monte Carlo";
    const float letter = ImGui::GetFontSize();
    list.AddText(onScreen({x - ImGui::CalcTextSize(a.c_str()).x - 0.6f * letter, 0.5f * letter}, corner_),
                 IM_COL32_WHITE, a.c_str());
    list.AddText(onScreen({x + 0.6f * letter, 0.5f * letter}, corner_), IM_COL32_WHITE, b.c_str());
  }
  list.PopClipRect();
}

}  // namespace sunfleck::view
