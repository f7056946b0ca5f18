#include "field/leaf_clusters.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <tuple>

namespace sunfleck {
namespace {

// Axes through the corners of an icosahedron that stands on an edge.
const std::array<glm::vec3, kFacings>& axes() {
  static const std::array<glm::vec3, kFacings> kAxes = [] {
    constexpr float kGolden = 1.6180340f;
    std::array<glm::vec3, kFacings> made{glm::vec3(0.f, 1.f, kGolden), glm::vec3(0.f, -1.f, kGolden),
                                         glm::vec3(1.f, kGolden, 0.f), glm::vec3(-1.f, kGolden, 0.f),
                                         glm::vec3(kGolden, 0.f, 1.f), glm::vec3(-kGolden, 0.f, 1.f)};
    for (glm::vec3& axis : made) axis = glm::normalize(axis);
    return made;
  }();
  return kAxes;
}

glm::ivec3 cellOf(const glm::vec3& point, float side) {
  return glm::ivec3(glm::floor(point / side));
}

auto keyOf(const glm::ivec3& cell) {
  return std::tuple(cell.z, cell.y, cell.x);
}

}  // namespace

Facing facingOf(const glm::vec3& normal) {
  Facing facing;
  float best = -1.f;
  for (std::size_t i = 0; i < kFacings; ++i) {
    const float cosine = glm::dot(axes()[i], normal);
    // A little in favour of the axes before, so that rounding does not decide.
    if (std::abs(cosine) > best + 1e-4f) {
      best = std::abs(cosine);
      facing = {static_cast<std::uint8_t>(i), cosine < 0.f};
    }
  }
  return facing;
}

// (F28)
LeafClusters leafClusters(const FieldElements& elements, float side) {
  struct Placed {
    glm::ivec3 cell;
    std::uint8_t wood;
    Facing facing;
    std::uint32_t element;
    auto key() const { return std::tuple_cat(keyOf(cell), std::tuple(wood, facing.axis)); }
  };
  std::vector<Placed> placed(elements.size());
  for (std::uint32_t i = 0; i < placed.size(); ++i)
    placed[i] = {cellOf(elements.centre[i], side), i >= elements.leaf_elements, facingOf(elements.normal[i]), i};
  std::ranges::sort(placed, [](const Placed& a, const Placed& b) {
    return a.key() != b.key() ? a.key() < b.key() : a.element < b.element;
  });
  LeafClusters clusters;
  clusters.of_side.resize(2 * elements.size());
  for (std::size_t begin = 0, end = 0; begin < placed.size(); begin = end) {
    glm::dvec3 centre(0.), normal(0.);
    double area = 0.;
    const auto number = static_cast<std::uint32_t>(clusters.size());
    for (; end < placed.size() && placed[end].key() == placed[begin].key(); ++end) {
      const std::uint32_t i = placed[end].element;
      const double of_element = (placed[end].wood ? 0.5 : 1.) * double{elements.area[i]};
      const bool against = placed[end].facing.against;
      area += of_element;
      centre += of_element * glm::dvec3(elements.centre[i]);
      normal += (against ? -of_element : of_element) * glm::dvec3(elements.normal[i]);
      clusters.of_side[2 * i] = 2 * number + (against ? 1 : 0);
      clusters.of_side[2 * i + 1] = 2 * number + (against ? 0 : 1);
    }
    clusters.centre.emplace_back(centre / area);
    clusters.normal.emplace_back(glm::normalize(normal));
    clusters.area.push_back(static_cast<float>(area));
    clusters.wood.push_back(placed[begin].wood);
    clusters.facing.push_back(placed[begin].facing.axis);
    clusters.cell.push_back(placed[begin].cell);
  }
  return clusters;
}

ClusterGroups clusterGroups(const LeafClusters& clusters, int cells) {
  ClusterGroups groups;
  std::map<std::tuple<int, int, int, std::uint8_t, std::uint8_t>, std::uint32_t> known;
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    const glm::ivec3 cell(glm::floor(glm::vec3(clusters.cell[i]) / static_cast<float>(cells)));
    const auto number = static_cast<std::uint32_t>(known.size());
    const auto key = std::tuple_cat(keyOf(cell), std::tuple(clusters.wood[i], clusters.facing[i]));
    groups.of_cluster.push_back(known.try_emplace(key, number).first->second);
  }
  groups.count = known.size();
  return groups;
}

std::size_t cellsTaken(const FieldElements& elements, float side) {
  std::vector<std::tuple<int, int, int>> cells(elements.size());
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i] = keyOf(cellOf(elements.centre[i], side));
  std::ranges::sort(cells);
  return static_cast<std::size_t>(std::ranges::unique(cells).begin() - cells.begin());
}

}  // namespace sunfleck
