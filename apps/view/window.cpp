#include "apps/view/window.hpp"

#include <dlfcn.h>

#include <stdexcept>
#include <utility>

namespace sunfleck::view {

// The library stays loaded: a driver does not like to be taken away.
std::unique_ptr<Window> openWindow(const std::string& title, glm::ivec2 size) {
  void* const library = dlopen(SUNFLECK_GLFW_WINDOW, RTLD_NOW | RTLD_LOCAL);
  void* const open = library ? dlsym(library, "sunfleckOpenWindow") : nullptr;
  if (!open) throw std::runtime_error(std::string("a window needs GLFW 3.3: ") + dlerror());
  return std::unique_ptr<Window>(reinterpret_cast<Window* (*)(const std::string&, glm::ivec2)>(open)(title, size));
}

namespace {

class Offscreen final : public Window {
 public:
  explicit Offscreen(glm::ivec2 size) : size_(size) {}
  Input poll(double) override {
    Input input;
    input.size = minimised_ ? glm::ivec2(0) : size_;
    input.held.assign(kKeys, false);
    return input;
  }
  void show(unsigned) override {}
  void resize(glm::ivec2 size) override { size_ = size; }
  void minimise() override { minimised_ = true; }
  void restore() override { minimised_ = false; }
  float scale() const override { return 1.f; }

 private:
  glm::ivec2 size_;
  bool minimised_ = false;
};

}  // namespace

std::unique_ptr<Window> openOffscreen(glm::ivec2 size) {
  return std::make_unique<Offscreen>(size);
}

}  // namespace sunfleck::view
