#pragma once

#include <initializer_list>
#include <string>

#include "render/gl/object_name.hpp"

namespace sunfleck::gl {

enum class Stage { vertex, fragment, compute };

struct Shader {
  Stage stage;
  std::string name;  // for messages
  std::string text;  // complete GLSL
};

// A linked program of the current context. Throws std::runtime_error with the compiler's first line when a shader does
// not compile or the stages do not fit.
class Program {
 public:
  explicit Program(std::initializer_list<Shader> shaders);
  void use() const;

 private:
  static void destroy(unsigned name);
  ObjectName<&Program::destroy> name_;
};

// A shader of the repository by its path.
Shader shaderOf(Stage stage, const std::string& path);

}  // namespace sunfleck::gl
