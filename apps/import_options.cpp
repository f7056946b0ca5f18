#include "apps/import_options.hpp"

namespace sunfleck::apps {

const char* ImportOptions::given() const {
  return !leaf.empty()    ? "--leaf"
         : !wood.empty()  ? "--wood"
         : scale != 1.f   ? "--scale"
         : !unit.empty()  ? "--unit"
         : !up.empty()    ? "--up"
         : !cards.empty() ? "--cards"
         : !mesh.empty()  ? "--mesh"
                          : nullptr;
}

ImportRules ImportOptions::rules() const {
  ImportRules rules{.leaf = leaf, .wood = wood, .scale = scale, .mesh = mesh};
  if (!unit.empty()) rules.scale = metresPer(unit, "--unit");
  if (!up.empty()) rules.up = upwardAxis(up, "--up");
  if (!cards.empty()) rules.cards = cardsNamed(cards, "--cards");
  return rules;
}

void addImportOptions(CLI::App& command, ImportOptions& options) {
  const std::string group = "How a mesh file is read";
  command
      .add_option("--leaf", options.leaf,
                  "Materials, groups or objects of the mesh that are leaves, such as 'leaf*'; '*' takes all. A "
                  "material's name comes before its groups', these before the object's")
      ->group(group);
  command.add_option("--wood", options.wood, "Materials, groups or objects of the mesh that are wood")->group(group);
  CLI::Option* scale = command.add_option("--scale", options.scale, "Metres per unit of the mesh (default 1)");
  scale->check(numberIn(1e-9, 1e9, "in [1e-9, 1e9]"))->group(group);
  command.add_option("--unit", options.unit, "Unit of the mesh in place of --scale: m, dm, cm, mm, km, in or ft")
      ->group(group)
      ->excludes(scale);
  command.add_option("--up", options.up, "Upward axis of the mesh: x, y or z (default: y of glTF, else z)")
      ->group(group);
  command
      .add_option(
          "--cards", options.cards,
          "Leaves that an image cuts out of faces: cut to triangles (default), mask (exact, for trace alone) or "
          "whole")
      ->group(group);
  command.add_option("--mesh", options.mesh, "Of a glTF stand of instances: the kind of tree to take")->group(group);
}

}  // namespace sunfleck::apps
