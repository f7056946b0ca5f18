#pragma once

#include <cstddef>
#include <memory>
#include <string>

namespace sunfleck::gl {

// An OpenGL 4.5 core context, current on the thread that made it until it is destroyed: one without a window or a
// display, or one that a window has made current and keeps. Throws std::runtime_error with one line that names what is
// needed when the machine offers none.
class Context {
 public:
  enum class Of { its_own, the_current };
  explicit Context(Of context = Of::its_own);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  std::string renderer() const;  // what draws, as the driver names it
  bool drawsInSoftware() const;  // on the processor
  void finish() const;           // returns when all that was asked for is done
  // Warnings of the driver and what it calls worth knowing, since this was made; notifications are not counted.
  std::size_t messages() const;
  // Throws std::runtime_error with the first error the driver has reported since the last call, if any.
  //   work  what was being done, for the message
  void requireNoError(const std::string& work) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace sunfleck::gl
