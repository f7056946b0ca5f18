#include "render/stand_trees.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

namespace sunfleck {
namespace {

constexpr std::size_t kNone = ~std::size_t{0};

}  // namespace

void StandTrees::update(FoliageStand& foliage, std::span<const Placement> trees,
                        std::span<const std::size_t> prototypes) {
  // Of the former trees of each prototype, those that are not yet found again.
  using Place = std::tuple<std::size_t, float, float, float>;
  const auto placeOf = [](std::size_t prototype, const glm::vec3& at) { return Place(prototype, at.x, at.y, at.z); };
  std::vector<Standing> now(trees.size());
  std::vector<char> kept(standing_.size(), 0);
  const auto keep = [&](std::size_t tree, std::size_t former) {
    now[tree] = standing_[former];
    kept[former] = 1;
  };
  const auto same = [&](std::size_t tree, std::size_t former) {
    return standing_[former].prototype == prototypes[tree] && standing_[former].position == trees[tree].position;
  };
  std::vector<std::size_t> left;  // trees that do not stand where one stood
  for (std::size_t tree = 0; tree < trees.size(); ++tree)
    if (tree < standing_.size() && same(tree, tree))
      keep(tree, tree);
    else
      left.push_back(tree);
  if (!left.empty()) {
    std::multimap<Place, std::size_t> places;
    for (std::size_t former = 0; former < standing_.size(); ++former)
      if (!kept[former]) places.emplace(placeOf(standing_[former].prototype, standing_[former].position), former);
    std::erase_if(left, [&](std::size_t tree) {
      const auto found = places.find(placeOf(prototypes[tree], trees[tree].position));
      if (found == places.end()) return false;
      keep(tree, found->second);
      places.erase(found);
      return true;
    });
  }
  // The rest has moved, has come or is gone; which of one prototype it was makes no difference to what follows, but the
  // one at the same place of the list keeps its number.
  for (const bool same_place : {true, false})
    std::erase_if(left, [&](std::size_t tree) {
      std::size_t former = kNone;
      if (same_place) {
        if (tree < standing_.size() && !kept[tree] && standing_[tree].prototype == prototypes[tree]) former = tree;
      } else {
        for (std::size_t i = 0; i < standing_.size() && former == kNone; ++i)
          if (!kept[i] && standing_[i].prototype == prototypes[tree]) former = i;
      }
      if (former == kNone) return false;
      keep(tree, former);
      return true;
    });
  for (std::size_t former = 0; former < standing_.size(); ++former)
    if (!kept[former]) {
      foliage.remove(standing_[former].instance);
      gone_.push_back(standing_[former]);
    }
  for (const std::size_t tree : left) {
    const auto again = std::find_if(gone_.begin(), gone_.end(),
                                    [&](const Standing& gone) { return gone.prototype == prototypes[tree]; });
    now[tree].prototype = prototypes[tree];
    if (again == gone_.end()) {
      now[tree].instance = foliage.add(prototypes[tree], trees[tree].position);
    } else {
      now[tree].instance = again->instance;
      gone_.erase(again);
    }
  }
  for (std::size_t tree = 0; tree < trees.size(); ++tree) {
    foliage.move(now[tree].instance, trees[tree].position);
    now[tree].position = trees[tree].position;
  }
  standing_ = std::move(now);
}

}  // namespace sunfleck
