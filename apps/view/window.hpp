#pragma once

#include <glm/vec2.hpp>
#include <memory>
#include <string>
#include <vector>

namespace sunfleck::view {

// Keys by their letter or sign; those without one by these.
enum Key : int {
  kEscape = 256,
  kEnter,
  kTab,
  kBackspace,
  kDelete,
  kLeft,
  kRight,
  kUp,
  kDown,
  kHome,
  kEnd,
  kShift,
  kControl,
  kKeys  // how many there are
};

// What mouse and keys did since the last call.
struct Input {
  glm::ivec2 size{0};        // of what is drawn on [pixel]; 0 while minimised
  glm::vec2 mouse{-1.f};     // from the upper left corner [pixel]
  bool buttons[3] = {};      // left, right, middle: held now
  float wheel = 0.f;         // steps, upwards
  std::vector<bool> held;    // of each key
  std::vector<int> pressed;  // keys, also by repetition
  std::vector<char32_t> typed;
  bool close = false;  // the person wants it to end
};

// A place to draw on with an OpenGL 4.5 core context, current on this thread as long as it lives.
class Window {
 public:
  virtual ~Window() = default;
  // Waits at most so long [s] for something to happen.
  virtual Input poll(double wait) = 0;
  // Shows framebuffer 0 if it can be seen, and `framebuffer` of the current size was copied there.
  virtual void show(unsigned framebuffer) = 0;
  virtual void resize(glm::ivec2 size) = 0;
  virtual void minimise() = 0;
  virtual void restore() = 0;
  virtual float scale() const = 0;  // of letters, by the display's setting
};

// A window on the display. Throws std::runtime_error that names what is needed: a display, OpenGL 4.5, the library.
std::unique_ptr<Window> openWindow(const std::string& title, glm::ivec2 size);
// None to be seen, for machines without a display; throws alike.
std::unique_ptr<Window> openOffscreen(glm::ivec2 size);

}  // namespace sunfleck::view
