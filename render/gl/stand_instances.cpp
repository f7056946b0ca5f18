#include "render/gl/stand_instances.hpp"

#include <glm/common.hpp>

namespace sunfleck::gl {
namespace {

// All trees, copies up to `reach` periods away included; those of the stand itself first.
std::vector<Neighbour> treesWithin(const Stand& stand, glm::ivec2 reach) {
  std::vector<Neighbour> trees;
  const auto place = [&](glm::vec3 shift) {
    for (std::size_t t = 0; t < stand.trees.size(); ++t)
      trees.push_back({.displacement = stand.trees[t].position + shift, .tree = static_cast<std::uint32_t>(t)});
  };
  place(glm::vec3(0.f));
  if (!stand.period) return trees;
  for (int y = -reach.y; y <= reach.y; ++y)
    for (int x = -reach.x; x <= reach.x; ++x)
      if (x != 0 || y != 0)
        place({static_cast<float>(x) * stand.period->x, static_cast<float>(y) * stand.period->y, 0});
  return trees;
}

glm::vec2 centreOf(const SunMap& map) {
  return map.corner + 0.5f * map.pixel_size * glm::vec2(map.size);
}

// Half the map's size, and the half pixel more that interpolation reaches [m].
glm::vec2 halfOf(const SunMap& map) {
  return 0.5f * map.pixel_size * (glm::vec2(map.size) + 1.f);
}

// Whether the map, moved by a displacement, meets a rectangle of half size `half` around `centre` [m, along the map's
// right and up].
bool meets(const SunMap& map, glm::vec3 displacement, glm::vec2 centre, glm::vec2 half) {
  const glm::vec2 distance = glm::abs(centreOf(map) + glm::vec2(map.alongAxes(displacement)) - centre);
  const glm::vec2 most = halfOf(map) + half;
  return distance.x < most.x && distance.y < most.y;
}

}  // namespace

StandInstances standInstances(const Stand& stand, glm::ivec2 periods_around, const SunMap& map,
                              const GroundDisc& ground) {
  StandInstances result;
  const std::vector<Neighbour> drawn = treesWithin(stand, glm::ivec2(1));
  const std::vector<Neighbour> all = treesWithin(stand, periods_around);

  for (std::size_t i = 0; i < drawn.size(); ++i) {
    if (i >= stand.trees.size()) {  // a copy stands in the same light as its tree
      Instance copy = result.drawn[drawn[i].tree];
      copy.position = drawn[i].displacement;
      result.drawn.push_back(copy);
      continue;
    }
    Instance tree{.position = drawn[i].displacement,
                  .tree = drawn[i].tree,
                  .first_neighbour = static_cast<std::uint32_t>(result.neighbours.size())};
    result.neighbours.push_back({.displacement = glm::vec3(0.f), .tree = tree.tree});
    for (std::size_t j = 0; j < all.size(); ++j) {
      const glm::vec3 displacement = all[j].displacement - tree.position;
      if (j != i && meets(map, displacement, centreOf(map), halfOf(map)))
        result.neighbours.push_back({.displacement = displacement, .tree = all[j].tree});
    }
    tree.neighbours_end = static_cast<std::uint32_t>(result.neighbours.size());
    result.drawn.push_back(tree);
  }

  result.ground.first_neighbour = static_cast<std::uint32_t>(result.neighbours.size());
  const glm::vec2 disc_centre = map.alongAxes(ground.centre) + map.origin;
  for (const Neighbour& tree : all)
    if (meets(map, tree.displacement, disc_centre, glm::vec2(ground.radius))) result.neighbours.push_back(tree);
  result.ground.neighbours_end = static_cast<std::uint32_t>(result.neighbours.size());
  return result;
}

}  // namespace sunfleck::gl
