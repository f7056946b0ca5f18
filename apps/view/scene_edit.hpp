#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "apps/view/document.hpp"

namespace sunfleck::view {

// The changes a person may make to a document. Each holds the new value whole, so that it can be made again.
struct SetSuns {
  std::vector<Sun> suns;  // 1 .. kMostSuns
};
struct SetSky {
  SceneSky sky;
};
struct SetGround {
  glm::vec3 albedo;  // Lambertian, in place of any other ground [1], 0 .. 1
};
struct SetOptics {
  std::size_t kind;
  BandOptics leaf;                            // of leaves that are told by numbers; of others the gloss alone
  glm::vec3 wood_reflectance;                 // [1], 0 .. 1
  LeafDescription description = {};           // how the leaves are told
  std::optional<LeafTextures> textures = {};  // none: those of the kind stay
};
struct SetModel {
  Model model;
};
struct SetEffort {
  GeometryEffort effort;
};
struct MoveTree {
  std::size_t tree;
  glm::vec3 position;  // [m]
};
struct TurnTree {
  std::size_t tree;
  float rotation;  // counter-clockwise from above [rad]; as many maps are made as there are different ones
};
struct AddTrees {
  std::vector<Placement> trees;  // not empty; the last becomes the selected one
};
struct RemoveTrees {
  std::vector<std::size_t> trees;  // of the stand, each once
};
struct AddKind {
  TreeKind kind;       // its name is made to differ from the others
  glm::vec3 position;  // of its first tree [m]
};
struct SaveCamera {
  SavedCamera camera;  // takes the place of one of the same name
};
struct ForgetCamera {
  std::string name;
};
using SceneEdit = std::variant<SetSuns, SetSky, SetGround, SetOptics, SetModel, SetEffort, MoveTree, TurnTree, AddTrees,
                               RemoveTrees, AddKind, SaveCamera, ForgetCamera>;

// What was done, for people: "move tree".
std::string nameOf(const SceneEdit& edit);

// Whether the stand's geometry or light may be others after it.
bool changesStand(const SceneEdit& edit);

// The document after the edit. Throws InvalidInput where a value is out of its range, or where the models cannot treat
// what would become of the stand.
Document edited(Document document, const SceneEdit& edit);

}  // namespace sunfleck::view
