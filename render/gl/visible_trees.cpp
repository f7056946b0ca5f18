#include "render/gl/visible_trees.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>

namespace sunfleck::gl {
namespace {

enum class Seen { no, partly, wholly };

Seen seen(const std::array<glm::vec4, 4>& sides, const Bounds& box, const glm::vec3& displacement) {
  const glm::vec3 centre = box.centre() + displacement, half = 0.5f * box.size();
  Seen result = Seen::wholly;
  for (const glm::vec4& side : sides) {
    const glm::vec3 inward(side);
    const float middle = glm::dot(inward, centre) + side.w, reach = glm::dot(glm::abs(inward), half);
    if (middle < -reach) return Seen::no;
    if (middle < reach) result = Seen::partly;
  }
  return result;
}

// From the eye to the box; 0 within.
float distanceTo(const Bounds& box, const glm::vec3& point) {
  return glm::length(glm::max(glm::max(box.low - point, point - box.high), glm::vec3(0.f)));
}

// The coarsest level whose enlarged pieces, turned anyhow, cover no more than so many pixels.
std::size_t levelFor(const std::vector<Level>& levels, float pixels_per_metre, float most_pixels) {
  std::size_t level = 0;
  while (level + 1 < levels.size() &&
         0.5f * levels[level + 1].piece_area * pixels_per_metre * pixels_per_metre <= most_pixels)
    ++level;
  return level;
}

}  // namespace

VisibleTrees visibleTrees(const TreeLevels& levels, std::span<const detail::DrawnData> trees, const View& view,
                          const glm::mat4& clip_from_world) {
  const std::array<glm::vec4, 4> sides = sidesOf(clip_from_world);
  const bool perspective = view.camera.perspective();
  const glm::vec3 eye = perspective ? eyeOf(view.camera) : glm::vec3(0.f);
  struct Chosen {
    const detail::DrawnData* tree;
    std::size_t leaves, wood;
    bool wholly;
  };
  std::vector<Chosen> chosen;
  for (const detail::DrawnData& tree : trees) {
    const Seen how = seen(sides, levels.box, tree.position);
    if (how == Seen::no) continue;
    const float pixels = pixelsPerMetre(view.camera, perspective ? distanceTo(levels.box, eye - tree.position) : 1.f);
    chosen.push_back({&tree, levelFor(levels.leaves, pixels, view.piece_pixels),
                      levelFor(levels.wood, pixels, view.piece_pixels), how == Seen::wholly});
  }

  VisibleTrees visible;
  const auto draw = [&](std::uint32_t first, std::uint32_t end, std::uint32_t base, std::size_t count) {
    if (first == end) return;
    visible.commands.push_back({.index_count = end - first,
                                .instance_count = static_cast<std::uint32_t>(count),
                                .first_index = first,
                                .base_instance = base});
    visible.triangles += (end - first) / 3 * count;
  };
  // Trees seen wholly are drawn together where they have the same level; of others the clusters that are seen.
  const auto drawLevels = [&](const std::vector<Level>& of, std::size_t Chosen::*level) {
    for (std::size_t l = 0; l < of.size(); ++l) {
      const auto base = static_cast<std::uint32_t>(visible.instances.size());
      for (const Chosen& c : chosen)
        if (c.wholly && c.*level == l) visible.instances.push_back(*c.tree);
      const std::size_t count = visible.instances.size() - base;
      if (count > 0) draw(of[l].firstIndex(), of[l].endIndex(), base, count);
    }
    for (const Chosen& c : chosen) {
      if (c.wholly) continue;
      const auto base = static_cast<std::uint32_t>(visible.instances.size());
      visible.instances.push_back(*c.tree);
      std::optional<std::uint32_t> first;
      std::uint32_t end = 0;
      for (const Cluster& cluster : of[c.*level].clusters) {
        const bool is_seen = seen(sides, cluster.box, c.tree->position) != Seen::no;
        if (is_seen && !first) first = cluster.first_index;
        if (is_seen) end = cluster.end_index;
        if (!is_seen && first) {
          draw(*first, end, base, 1);
          first.reset();
        }
      }
      if (first) draw(*first, end, base, 1);
    }
  };
  drawLevels(levels.leaves, &Chosen::leaves);
  drawLevels(levels.wood, &Chosen::wood);
  return visible;
}

}  // namespace sunfleck::gl
