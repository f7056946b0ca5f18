#include "render/gl/context.hpp"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace sunfleck::gl {
namespace {

[[noreturn]] void unavailable(const std::string& reason) {
  throw std::runtime_error("OpenGL 4.5 is not available: " + reason);
}

std::string eglError() {
  std::ostringstream text;
  text << "EGL error 0x" << std::hex << eglGetError();
  return text.str();
}

bool offers(const char* extensions, std::string_view wanted) {
  std::istringstream words(extensions ? extensions : "");
  for (std::string word; words >> word;)
    if (word == wanted) return true;
  return false;
}

// Initialises the display if there is one; EGL_NO_DISPLAY otherwise.
EGLDisplay initialised(EGLDisplay display) {
  return display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) ? display : EGL_NO_DISPLAY;
}

EGLDisplay firstDevice(const char* extensions) {
  if (!offers(extensions, "EGL_EXT_platform_device") || !offers(extensions, "EGL_EXT_device_enumeration"))
    return EGL_NO_DISPLAY;
  std::array<EGLDeviceEXT, 16> devices{};
  EGLint count = 0;
  if (!eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count)) return EGL_NO_DISPLAY;
  for (EGLint i = 0; i < count; ++i) {
    const EGLDisplay display =
        initialised(eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[static_cast<std::size_t>(i)], nullptr));
    if (display != EGL_NO_DISPLAY) return display;
  }
  return EGL_NO_DISPLAY;
}

EGLDisplay openDisplay() {
  if (!epoxy_has_egl()) unavailable("there is no EGL library");
  const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  EGLDisplay display = EGL_NO_DISPLAY;
  // epoxy knows an extension's functions by the extension's own name before a display exists: eglGetPlatformDisplayEXT
  // works here, eglGetPlatformDisplay ends the program.
  if (offers(extensions, "EGL_EXT_platform_base") && offers(extensions, "EGL_MESA_platform_surfaceless"))
    display = initialised(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
  if (display == EGL_NO_DISPLAY && offers(extensions, "EGL_EXT_platform_base")) display = firstDevice(extensions);
  if (display == EGL_NO_DISPLAY) display = initialised(eglGetDisplay(EGL_DEFAULT_DISPLAY));
  if (display == EGL_NO_DISPLAY) unavailable("EGL opens neither a surfaceless, a device nor a default display");
  return display;
}

// EGL counts no owners of a display: terminating it ends every context on it. So all contexts share one, which stays
// for the life of the process, and with it the driver.
EGLDisplay sharedDisplay() {
  static const EGLDisplay display = openDisplay();
  return display;
}

}  // namespace

struct Context::State {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  std::string first_error;
  std::size_t messages = 0;

  explicit State(Of of) {
    if (of == Of::its_own)
      makeOwn();
    else if (epoxy_gl_version() < 45 || !epoxy_is_desktop_gl())
      unavailable("the window's is " + std::string(reinterpret_cast<const char*>(glGetString(GL_VERSION))));
  }
  void makeOwn() {
    display = sharedDisplay();
    if (!eglBindAPI(EGL_OPENGL_API)) unavailable("EGL has no desktop OpenGL");
    if (!epoxy_has_egl_extension(display, "EGL_KHR_surfaceless_context"))
      unavailable("EGL cannot draw without a surface (EGL_KHR_surfaceless_context)");
    constexpr std::array<EGLint, 5> wanted{EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglChooseConfig(display, wanted.data(), &config, 1, &count) || count == 0) config = EGL_NO_CONFIG_KHR;
    constexpr std::array<EGLint, 9> attributes{EGL_CONTEXT_MAJOR_VERSION,
                                               4,
                                               EGL_CONTEXT_MINOR_VERSION,
                                               5,
                                               EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                               EGL_CONTEXT_OPENGL_DEBUG,
                                               EGL_TRUE,
                                               EGL_NONE};
    context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes.data());
    if (context == EGL_NO_CONTEXT) unavailable("no core context can be made, " + eglError());
    if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
      const std::string reason = "the context cannot be made current, " + eglError();
      eglDestroyContext(display, context);
      unavailable(reason);
    }
  }
  ~State() {
    if (context == EGL_NO_CONTEXT) return;
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display, context);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
};

Context::Context(Of context) : state_(std::make_unique<State>(context)) {
  // The driver calls this from C: it must not throw, so the error waits for requireNoError.
  const auto remember = [](GLenum, GLenum type, GLuint, GLenum severity, GLsizei, const GLchar* message,
                           const void* user) {
    State& state = *static_cast<State*>(const_cast<void*>(user));
    if (severity != GL_DEBUG_SEVERITY_NOTIFICATION) ++state.messages;
    if (type == GL_DEBUG_TYPE_ERROR && state.first_error.empty()) state.first_error = message;
  };
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(remember, state_.get());
}

Context::~Context() {
  glDebugMessageCallback(nullptr, nullptr);
}

std::size_t Context::messages() const {
  return state_->messages;
}

std::string Context::renderer() const {
  return reinterpret_cast<const char*>(glGetString(GL_RENDERER));
}

bool Context::drawsInSoftware() const {
  const std::string name = renderer();
  constexpr std::array<std::string_view, 4> known{"llvmpipe", "softpipe", "SWR", "SwiftShader"};
  return std::ranges::any_of(known, [&](std::string_view of) { return name.find(of) != std::string::npos; });
}

void Context::finish() const {
  glFinish();
}

void Context::requireNoError(const std::string& work) const {
  std::string error = std::exchange(state_->first_error, {});
  const GLenum code = glGetError();
  if (error.empty() && code != GL_NO_ERROR) error = "error " + std::to_string(code);
  error.resize(std::min(error.find('\n'), error.size()));
  if (!error.empty()) throw std::runtime_error("OpenGL failed while " + work + ": " + error);
}

}  // namespace sunfleck::gl
