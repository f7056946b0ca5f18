// GLFW and the libraries of windows that it brings, in a library of its own, loaded when a window is opened.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <dlfcn.h>
#include <epoxy/gl.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <stdexcept>
#include <utility>

#include "apps/view/window.hpp"

namespace sunfleck::view {
namespace {

std::string lastError() {
  const char* text = nullptr;
  return glfwGetError(&text) != GLFW_NO_ERROR && text ? text : "no reason is told";
}

// What Xlib calls when the connection to the display breaks, on any thread: it must not return.
int displayIsLost(void*) {
  std::fputs("sunfleck: failed: the display is lost: its server has ended or has closed the connection\n", stderr);
  std::_Exit(1);
}

// GLFW may not use Xlib at all: then it is not loaded.
void endInOneLineWithoutDisplay() {
  void* const xlib = dlopen("libX11.so.6", RTLD_LAZY | RTLD_NOLOAD);
  void* const set = xlib ? dlsym(xlib, "XSetIOErrorHandler") : nullptr;
  using Handler = int (*)(void* display);
  if (set) reinterpret_cast<Handler (*)(Handler)>(set)(displayIsLost);
}

int keyOf(int glfw) {
  static const std::map<int, int> kNamed{
      {GLFW_KEY_ESCAPE, kEscape},
      {GLFW_KEY_ENTER, kEnter},
      {GLFW_KEY_KP_ENTER, kEnter},
      {GLFW_KEY_TAB, kTab},
      {GLFW_KEY_BACKSPACE, kBackspace},
      {GLFW_KEY_DELETE, kDelete},
      {GLFW_KEY_LEFT, kLeft},
      {GLFW_KEY_RIGHT, kRight},
      {GLFW_KEY_UP, kUp},
      {GLFW_KEY_DOWN, kDown},
      {GLFW_KEY_HOME, kHome},
      {GLFW_KEY_END, kEnd},
      {GLFW_KEY_LEFT_SHIFT, kShift},
      {GLFW_KEY_RIGHT_SHIFT, kShift},
      {GLFW_KEY_LEFT_CONTROL, kControl},
      {GLFW_KEY_RIGHT_CONTROL, kControl},
  };
  const auto named = kNamed.find(glfw);
  if (named != kNamed.end()) return named->second;
  return glfw >= GLFW_KEY_SPACE && glfw <= GLFW_KEY_GRAVE_ACCENT ? glfw : -1;
}

class GlfwWindow final : public Window {
 public:
  GlfwWindow(const std::string& title, glm::ivec2 size) {
    if (!glfwInit()) throw std::runtime_error("a window needs a display (DISPLAY or WAYLAND_DISPLAY): " + lastError());
    endInOneLineWithoutDisplay();
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, GLFW_TRUE);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    window_ = glfwCreateWindow(size.x, size.y, title.c_str(), nullptr, nullptr);
    if (!window_) {
      const std::string reason = lastError();
      throw std::runtime_error(
          "a window needs OpenGL 4.5 (core profile), which this display's driver does not offer: " + reason);
    }
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
    glfwSetWindowUserPointer(window_, this);
    glfwSetInputMode(window_, GLFW_STICKY_MOUSE_BUTTONS, GLFW_TRUE);  // a click may be shorter than a frame
    input_.held.assign(kKeys, false);
    glfwSetScrollCallback(window_,
                          [](GLFWwindow* w, double, double steps) { of(w).input_.wheel += static_cast<float>(steps); });
    glfwSetCharCallback(window_, [](GLFWwindow* w, unsigned code) { of(w).input_.typed.push_back(code); });
    glfwSetKeyCallback(window_, [](GLFWwindow* w, int glfw, int, int action, int) {
      const int key = keyOf(glfw);
      if (key < 0) return;
      of(w).input_.held[static_cast<std::size_t>(key)] = action != GLFW_RELEASE;
      if (action != GLFW_RELEASE) of(w).input_.pressed.push_back(key);
    });
  }
  // The display stays open until the program ends, as closing it takes the driver's library away: what that keeps could
  // not be told from leaks.
  ~GlfwWindow() override { glfwDestroyWindow(window_); }

  Input poll(double wait) override {
    if (wait > 0.)
      glfwWaitEventsTimeout(wait);
    else
      glfwPollEvents();
    glm::ivec2 size, extent;
    glfwGetFramebufferSize(window_, &size.x, &size.y);
    glfwGetWindowSize(window_, &extent.x, &extent.y);
    input_.size = glfwGetWindowAttrib(window_, GLFW_ICONIFIED) ? glm::ivec2(0) : size;
    double x = 0., y = 0.;
    glfwGetCursorPos(window_, &x, &y);
    input_.mouse = glm::vec2(x, y) * glm::vec2(size) / glm::vec2(std::max(extent.x, 1), std::max(extent.y, 1));
    for (int button = 0; button < 3; ++button)  // GLFW counts left, right, middle
      input_.buttons[button] = glfwGetMouseButton(window_, button) == GLFW_PRESS;
    input_.close = glfwWindowShouldClose(window_);
    Input now = input_;
    input_.wheel = 0.f;
    input_.pressed.clear();
    input_.typed.clear();
    return now;
  }
  void show(unsigned framebuffer) override {
    glm::ivec2 size;
    glfwGetFramebufferSize(window_, &size.x, &size.y);
    if (size.x <= 0 || size.y <= 0 || glfwGetWindowAttrib(window_, GLFW_ICONIFIED)) return;
    glBlitNamedFramebuffer(framebuffer, 0, 0, 0, size.x, size.y, 0, 0, size.x, size.y, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glfwSwapBuffers(window_);
  }
  void resize(glm::ivec2 size) override { glfwSetWindowSize(window_, size.x, size.y); }
  void minimise() override { glfwIconifyWindow(window_); }
  void restore() override { glfwRestoreWindow(window_); }
  float scale() const override {
    float x = 1.f, y = 1.f;
    glfwGetWindowContentScale(window_, &x, &y);
    return std::max(1.f, x);
  }

 private:
  static GlfwWindow& of(GLFWwindow* window) { return *static_cast<GlfwWindow*>(glfwGetWindowUserPointer(window)); }
  GLFWwindow* window_ = nullptr;
  Input input_;
};

}  // namespace
}  // namespace sunfleck::view

extern "C" sunfleck::view::Window* sunfleckOpenWindow(const std::string& title, glm::ivec2 size) {
  return new sunfleck::view::GlfwWindow(title, size);
}
