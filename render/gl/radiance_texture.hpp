#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <string>

#include "render/gl/object_name.hpp"

namespace sunfleck::gl {

// A table of values of three bands that shaders read: cell by cell, or interpolated between the middles of cells.
class RadianceTexture {
 public:
  enum class Read { cells, interpolated };
  //   what  it holds, for messages: "a sky"
  RadianceTexture(Read read, std::string what);
  // `values` row by row. Throws TooLarge with the figure.
  void assign(glm::ivec2 size, std::span<const glm::vec3> values);
  void bind(unsigned unit) const;

 private:
  static void destroy(unsigned name);
  Read read_;
  std::string what_;
  ObjectName<&RadianceTexture::destroy> name_;
};

}  // namespace sunfleck::gl
