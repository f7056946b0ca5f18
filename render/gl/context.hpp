#pragma once

#include <memory>
#include <string>

namespace sunfleck::gl {

// An OpenGL 4.5 core context, current on the thread that made it until it is destroyed. Throws std::runtime_error with
// one line when the machine offers none.
class Context {
 public:
  Context();  // without a window or a display
  // The one that is current, such as a window's; its owner keeps it.
  enum class Adopt { current };
  explicit Context(Adopt);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  std::string renderer() const;  // what draws, as the driver names it
  // Throws std::runtime_error with the first error the driver has reported since the last call, if any.
  //   work  what was being done, for the message
  void requireNoError(const std::string& work) const;

 private:
  void listen();  // to what the driver reports
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace sunfleck::gl
