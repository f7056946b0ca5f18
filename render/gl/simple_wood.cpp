#include "render/gl/detail/simple_wood.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <map>
#include <unordered_map>
#include <utility>

#include "render/gl/detail/thinning.hpp"

namespace sunfleck::gl::detail {
namespace {

constexpr float kThin = 0.5f;  // of `reach`: triangles with a shorter side are part of a bone

// Vertices joined into one.
struct Joint {
  glm::dvec3 sum{0.};
  double count = 0.;
  glm::vec3 first{0.f};
  glm::vec3 place() const { return sum / count; }
};

// Joins the vertices of the wood that lie within a distance of the first of a joint: the last joint made, which along a
// twig is the nearest, or one near it of the same part of the mesh.
class Joints {
 public:
  Joints(const TreeMesh& mesh, float reach) : reach_(0.5f * reach), of_vertex_(mesh.vertices.size(), kNone) {
    for (const glm::uvec3& triangle : mesh.wood_triangles)
      for (int corner = 0; corner < 3; ++corner) {
        std::uint32_t& joint = of_vertex_[triangle[corner]];
        if (joint == kNone) joint = joined(mesh.vertices[triangle[corner]]);
      }
  }
  std::uint32_t of(std::uint32_t vertex) const { return of_vertex_[vertex]; }
  glm::vec3 place(std::uint32_t joint) const { return joints_[joint].place(); }
  std::size_t count() const { return joints_.size(); }

 private:
  static constexpr std::uint32_t kNone = ~0u;

  glm::ivec3 cellOf(const glm::vec3& at) const { return glm::ivec3(glm::floor(at / reach_)); }
  static std::uint64_t key(const glm::ivec3& cell) {
    const auto part = [](int x) { return static_cast<std::uint64_t>(x + (1 << 20)) & 0x1fffff; };
    return part(cell.x) << 42 | part(cell.y) << 21 | part(cell.z);
  }
  bool near(std::uint32_t joint, const glm::vec3& at) const { return glm::distance(joints_[joint].first, at) < reach_; }

  std::uint32_t joined(const glm::vec3& at) {
    std::uint32_t found = !joints_.empty() && near(last_, at) ? last_ : kNone;
    const glm::ivec3 cell = cellOf(at);
    for (int i = 0; i < 27 && found == kNone; ++i)
      if (const auto in_cell = cells_.find(key(cell + glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1));
          in_cell != cells_.end())
        for (const std::uint32_t joint : in_cell->second)
          if (found == kNone && near(joint, at)) found = joint;
    if (found == kNone) {
      found = static_cast<std::uint32_t>(joints_.size());
      joints_.push_back({.first = at});
      cells_[key(cell)].push_back(found);
    }
    joints_[found].sum += glm::dvec3(at);
    joints_[found].count += 1.;
    return last_ = found;
  }

  float reach_;
  std::vector<Joint> joints_;
  std::vector<std::uint32_t> of_vertex_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
  std::uint32_t last_ = 0;
};

// A unit vector across another, turned anyhow but the same each time.
glm::vec3 across(const glm::vec3& along, std::size_t number) {
  const glm::vec3 axis = std::abs(along.z) < 0.9f ? glm::vec3(0.f, 0.f, 1.f) : glm::vec3(1.f, 0.f, 0.f);
  const glm::vec3 u = glm::normalize(glm::cross(along, axis)), v = glm::cross(along, u);
  const float angle = 2.3999632f * static_cast<float>(number % 4096);  // the golden angle: even over all turns
  return std::cos(angle) * u + std::sin(angle) * v;
}

}  // namespace

SimpleWood simpleWood(const TreeMesh& mesh, float reach, float piece_area) {
  const Joints joints(mesh, reach);
  SimpleWood wood{.triangles = {}, .shared_count = joints.count()};
  struct Bone {
    double surface = 0.;  // around it [m^2]
    std::uint32_t source = ~0u;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, Bone> bones;
  std::map<std::array<std::uint32_t, 3>, bool> taken;
  auto source = static_cast<std::uint32_t>(mesh.leaf_triangles.size()) - 1u;
  for (const glm::uvec3& triangle : mesh.wood_triangles) {
    ++source;
    std::array<std::uint32_t, 3> joint{};
    std::array<glm::vec3, 3> corners{};
    for (std::size_t i = 0; i < 3; ++i) {
      joint[i] = joints.of(triangle[static_cast<int>(i)]);
      corners[i] = joints.place(joint[i]);
    }
    std::size_t longest = 0;
    float longest_side = -1.f, shortest_side = 1e30f;
    for (std::size_t i = 0; i < 3; ++i) {
      const float side = glm::distance(corners[i], corners[(i + 1) % 3]);
      shortest_side = std::min(shortest_side, side);
      if (side > longest_side) longest_side = side, longest = i;
    }
    if (longest_side <= 0.f) continue;  // all in one place: too small to be seen
    if (shortest_side < kThin * reach) {
      Bone& bone = bones[std::minmax(joint[longest], joint[(longest + 1) % 3])];
      bone.surface += triangleArea(mesh, triangle);
      bone.source = std::min(bone.source, source);
      continue;
    }
    std::array<std::uint32_t, 3> sorted = joint;
    std::ranges::sort(sorted);
    if (glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0])) < 1e-6f * reach * reach ||
        !taken.emplace(sorted, true).second)
      continue;
    wood.triangles.push_back(
        {.corners = corners, .shared = joint, .middle = glm::vec3(reach, 0.f, 0.f), .source = source});
  }

  std::vector<double> areas;
  for (const auto& [ends, bone] : bones) areas.push_back(0.5 * bone.surface);
  const std::vector<float> rank = ranks(areas.size());
  const std::vector<float> enlargement = thinned(areas, rank, double{piece_area});
  std::size_t number = 0;
  for (const auto& [ends, bone] : bones) {
    const std::size_t piece = number++;
    if (enlargement[piece] == 0.f) continue;
    const glm::vec3 a = joints.place(ends.first), b = joints.place(ends.second), middle = 0.5f * (a + b);
    const float length = glm::distance(a, b);
    // A triangle along the bone with its tip at either end.
    const glm::vec3 along = (piece % 2 == 0 ? 0.5f : -0.5f) * enlargement[piece] * (b - a);
    const glm::vec3 aside =
        enlargement[piece] * static_cast<float>(areas[piece]) / length * across((b - a) / length, piece);
    const auto first = static_cast<std::uint32_t>(wood.shared_count);
    wood.triangles.push_back({.corners = {middle - along - aside, middle + along, middle - along + aside},
                              .shared = {first, first + 1, first + 2},
                              .middle = middle,
                              .leaf = TriangleData::kThinWood,
                              .enlargement = enlargement[piece],
                              .source = bone.source});
    wood.shared_count += 3;
  }
  return wood;
}

}  // namespace sunfleck::gl::detail
