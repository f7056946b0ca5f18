#include "plants/detail/tube.hpp"

#include <algorithm>
#include <numbers>

#include "plants/detail/portable_math.hpp"

namespace sunfleck::detail {
namespace {

std::uint32_t sidesOf(const WeberPenn& parameters, int level) {
  constexpr std::array<int, 4> sides{12, 8, 5, 4};
  // Six sides per lobe draw its wave.
  const int lobed = level == 0 ? 6 * parameters.lobes : 0;
  return static_cast<std::uint32_t>(std::max(lobed, sides[static_cast<std::size_t>(level)]));
}

std::uint32_t addVertex(TreeMesh& mesh, const glm::dvec3& position) {
  mesh.vertices.emplace_back(position);
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

// Stations where the tube has rings: the strand's, and on the trunk some more where the flare is steep.
Strand ringStations(const WeberPenn& parameters, const Bud& bud, const Strand& strand) {
  Strand rings = strand;
  if (bud.level > 0 || parameters.flare == 0.f || strand.front().distance > 0.) return rings;
  for (const double z : {0.01, 0.025, 0.05, 0.09}) {
    const double distance = z * bud.length;
    if (distance < strand[1].distance)
      rings.insert(std::find_if(rings.begin(), rings.end(), [&](const Station& s) { return s.distance > distance; }),
                   {frameAt(strand, distance), distance});
  }
  return rings;
}

}  // namespace

void addTube(const WeberPenn& parameters, const Bud& bud, const Strand& strand, TreeMesh& mesh) {
  const std::uint32_t sides = sidesOf(parameters, bud.level);
  const Strand rings = ringStations(parameters, bud, strand);
  const double tip_radius = radiusAt(parameters, bud, 1.);
  const bool pointed = tip_radius < 0.05 * bud.radius;
  std::uint32_t previous = 0;
  for (std::size_t i = 0; i + (pointed ? 1 : 0) < rings.size(); ++i) {
    const Frame& frame = rings[i].frame;
    // A ring between two segments lies in the plane that halves their angle.
    const glm::dvec3 along = glm::normalize(frame.along + (i > 0 ? rings[i - 1].frame.along : frame.along));
    const glm::dvec3 right = glm::normalize(frame.right - glm::dot(frame.right, along) * along);
    const glm::dvec3 up = glm::cross(along, right);
    const double radius = radiusAt(parameters, bud, rings[i].distance / bud.length);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (std::uint32_t side = 0; side < sides; ++side) {
      const double angle = 2. * std::numbers::pi * side / sides;
      const double lobe =
          bud.level == 0 ? 1. + double{parameters.lobe_depth} * portable::sine(double(parameters.lobes) * angle) : 1.;
      addVertex(mesh, frame.position + radius * lobe * (portable::cosine(angle) * right + portable::sine(angle) * up));
    }
    for (std::uint32_t side = 0; i > 0 && side < sides; ++side) {
      const std::uint32_t next = (side + 1) % sides;
      mesh.wood_triangles.push_back({previous + side, previous + next, first + next});
      mesh.wood_triangles.push_back({previous + side, first + next, first + side});
    }
    previous = first;
  }
  const std::uint32_t tip = addVertex(mesh, rings.back().frame.position);
  for (std::uint32_t side = 0; side < sides; ++side)
    mesh.wood_triangles.push_back({previous + side, previous + (side + 1) % sides, tip});
}

}  // namespace sunfleck::detail
