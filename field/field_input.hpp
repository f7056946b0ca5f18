#pragma once

#include <memory>
#include <span>

#include "core/stand.hpp"
#include "core/tree_mesh.hpp"
#include "field/leaf_field.hpp"

namespace sunfleck {

// What the field of a stand asks of trees and light. Throw InvalidInput on no tree, a tree of no kind, a mesh without
// leaves or with leaves that masks cut out, a place or period that is not finite; and on a value out of its range.
void requireStand(std::span<const std::shared_ptr<const TreeMesh>> kinds, const Stand& stand);
void requireLighting(const FieldLighting& lighting, std::size_t kinds);

}  // namespace sunfleck
