#pragma once

#include <utility>

namespace sunfleck::gl {

// Owns one object of the current OpenGL context: `destroy` is called with its name when the owner goes.
template <void (*destroy)(unsigned)>
class ObjectName {
 public:
  explicit ObjectName(unsigned name) : name_(name) {}
  ~ObjectName() {
    if (name_ != 0) destroy(name_);
  }
  ObjectName(ObjectName&& other) noexcept : name_(std::exchange(other.name_, 0u)) {}
  ObjectName& operator=(ObjectName&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  unsigned get() const { return name_; }

 private:
  unsigned name_;
};

}  // namespace sunfleck::gl
