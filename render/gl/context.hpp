#pragma once

#include <memory>
#include <string>

namespace sunfleck::gl {

// An OpenGL 4.5 core context without a window or a display, current on the thread that made it until it is destroyed.
// Throws std::runtime_error with one line when the machine offers none.
class Context {
 public:
  Context();
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  std::string renderer() const;  // what draws, as the driver names it
  bool drawsInSoftware() const;  // on the processor
  void finish() const;           // returns when all that was asked for is done
  // Throws std::runtime_error with the first error the driver has reported since the last call, if any.
  //   work  what was being done, for the message
  void requireNoError(const std::string& work) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace sunfleck::gl
