#include "render/gl/program.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "render/gl/shader_text.hpp"

namespace sunfleck::gl {
namespace {

constexpr std::size_t kLongestLog = 4096;

std::string firstLine(std::string log) {
  log.resize(std::min(log.find('\n'), log.size()));
  return log;
}

void destroyShader(unsigned name) {
  glDeleteShader(name);
}

GLenum kindOf(Stage stage) {
  switch (stage) {
    case Stage::vertex:
      return GL_VERTEX_SHADER;
    case Stage::fragment:
      return GL_FRAGMENT_SHADER;
    case Stage::compute:
      break;
  }
  return GL_COMPUTE_SHADER;
}

ObjectName<destroyShader> compiled(const Shader& shader) {
  ObjectName<destroyShader> name(glCreateShader(kindOf(shader.stage)));
  const char* text = shader.text.c_str();
  glShaderSource(name.get(), 1, &text, nullptr);
  glCompileShader(name.get());
  GLint done = GL_FALSE;
  glGetShaderiv(name.get(), GL_COMPILE_STATUS, &done);
  if (done) return name;
  std::string log(kLongestLog, '\0');
  GLsizei length = 0;
  glGetShaderInfoLog(name.get(), static_cast<GLsizei>(log.size()), &length, log.data());
  log.resize(static_cast<std::size_t>(length));
  throw std::runtime_error(shader.name + ": does not compile: " + firstLine(log));
}

}  // namespace

Program::Program(std::initializer_list<Shader> shaders) : name_(glCreateProgram()) {
  std::string names;
  std::vector<ObjectName<destroyShader>> stages;
  for (const Shader& shader : shaders) {
    names += (names.empty() ? "" : " and ") + shader.name;
    stages.push_back(compiled(shader));
    glAttachShader(name_.get(), stages.back().get());
  }
  glLinkProgram(name_.get());
  for (const auto& stage : stages) glDetachShader(name_.get(), stage.get());
  GLint done = GL_FALSE;
  glGetProgramiv(name_.get(), GL_LINK_STATUS, &done);
  if (done) return;
  std::string log(kLongestLog, '\0');
  GLsizei length = 0;
  glGetProgramInfoLog(name_.get(), static_cast<GLsizei>(log.size()), &length, log.data());
  log.resize(static_cast<std::size_t>(length));
  throw std::runtime_error(names + ": do not link: " + firstLine(log));
}

void Program::use() const {
  glUseProgram(name_.get());
}

void Program::destroy(unsigned name) {
  glDeleteProgram(name);
}

Shader shaderOf(Stage stage, const std::string& path) {
  return {.stage = stage, .name = path, .text = shaderText(path)};
}

}  // namespace sunfleck::gl
