#pragma once

#include "apps/view/window.hpp"

struct ImGuiContext;

namespace sunfleck::view {

// Dear ImGui with our look, fed by a Window and drawn on the framebuffer that is bound. One at a time, in the window's
// OpenGL context.
class Gui {
 public:
  explicit Gui(float scale);  // of letters
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  void begin(const Input& input, float seconds);  // since the last frame
  void draw();                                    // what was said since begin()
  bool wantsMouse() const;                        // it lies over a panel
  bool wantsKeys() const;                         // somebody types

 private:
  ImGuiContext* context_;
};

}  // namespace sunfleck::view
