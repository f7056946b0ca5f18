#include "render/gl/opacity_map_store.hpp"

#include <algorithm>

#include "render/scene.hpp"

namespace sunfleck::gl {

const OpacityMap& OpacityMapStore::map(const std::shared_ptr<const TreeMesh>& mesh, Direction along, int resolution) {
  std::erase_if(trees_, [&](const Tree& tree) { return tree.mesh != mesh && tree.mesh.use_count() == 1; });
  auto tree = std::ranges::find(trees_, mesh, &Tree::mesh);
  if (tree == trees_.end()) tree = trees_.insert(tree, {.mesh = mesh, .mapped = MappedTree(*mesh), .maps = {}});
  auto& maps = tree->maps;
  const auto found = std::ranges::find_if(maps, [&](const Kept& kept) { return kept.is(along, resolution); });
  if (found != maps.end())
    maps.splice(maps.begin(), maps, found);
  else
    maps.push_front({along, resolution, maker_.make(tree->mapped, along, resolution)});
  if (maps.size() > kMostSuns) maps.pop_back();
  return maps.front().map;
}

const OpacityMap* OpacityMapStore::find(const std::shared_ptr<const TreeMesh>& mesh, Direction along,
                                        int resolution) const {
  const auto tree = std::ranges::find(trees_, mesh, &Tree::mesh);
  if (tree == trees_.end()) return nullptr;
  const auto found = std::ranges::find_if(tree->maps, [&](const Kept& kept) { return kept.is(along, resolution); });
  return found == tree->maps.end() ? nullptr : &found->map;
}

}  // namespace sunfleck::gl
