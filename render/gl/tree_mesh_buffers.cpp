#include "render/gl/tree_mesh_buffers.hpp"

#include <epoxy/gl.h>

#include <cstddef>

namespace sunfleck::gl {
namespace {

unsigned created() {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  return name;
}

}  // namespace

TreeMeshBuffers::TreeMeshBuffers(const TreeLevels& levels)
    : vertices_(levels.vertices), indices_(levels.indices), array_(created()) {
  const GLuint name = array_.get();
  glVertexArrayVertexBuffer(name, 0, vertices_.name(), 0, sizeof(glm::vec3));
  glVertexArrayElementBuffer(name, indices_.name());
  for (GLuint attribute = 0; attribute < 3; ++attribute) {
    glEnableVertexArrayAttrib(name, attribute);
    glVertexArrayAttribBinding(name, attribute, attribute == 0 ? 0 : 1);
  }
  glVertexArrayBindingDivisor(name, 1, 1);
  glVertexArrayAttribFormat(name, 0, 3, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribFormat(name, 1, 3, GL_FLOAT, GL_FALSE, offsetof(detail::DrawnData, position));
  glVertexArrayAttribIFormat(name, 2, 1, GL_UNSIGNED_INT, offsetof(detail::DrawnData, number));
}

void TreeMeshBuffers::draw(const VisibleTrees& visible) const {
  if (visible.commands.empty()) return;
  const Buffer instances(visible.instances), commands(visible.commands);
  glVertexArrayVertexBuffer(array_.get(), 1, instances.name(), 0, sizeof(detail::DrawnData));
  glBindVertexArray(array_.get());
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands.name());
  glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, nullptr, static_cast<GLsizei>(visible.commands.size()), 0);
}

void TreeMeshBuffers::destroy(unsigned name) {
  glDeleteVertexArrays(1, &name);
}

}  // namespace sunfleck::gl
