#include "plants/detail/leaf_placement.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "plants/detail/budding.hpp"
#include "plants/detail/portable_math.hpp"

namespace sunfleck::detail {
namespace {

constexpr double kPetioleRadius = 0.01;  // at its foot, over the leaf's length [1]: 0.6 mm of a leaf of 6 cm

// Weber & Penn's leaf orientation: turn the leaf's face by the share `bend` outward, about the vertical, and then up.
void bendToLight(Frame& leaf, double bend) {
  const glm::dvec3 vertical(0., 0., 1.);
  const glm::dvec3 face = leaf.up();
  const double outward = portable::arctangent(leaf.position.y, leaf.position.x) - portable::arctangent(face.y, face.x);
  leaf.turn(vertical, bend * std::remainder(outward, 2. * std::numbers::pi));
  const glm::dvec3 turned = leaf.up();
  const glm::dvec3 axis = glm::cross(turned, vertical);
  if (glm::length(axis) > 1e-6)
    leaf.turn(glm::normalize(axis), bend * portable::arctangent(portable::length(turned.x, turned.y), turned.z));
}

std::uint32_t nextVertex(const TreeMesh& mesh) {
  return static_cast<std::uint32_t>(mesh.vertices.size());
}

// A pointed cone of three sides.
void addPetiole(const Frame& foot, double length, double radius, TreeMesh& mesh) {
  const std::uint32_t first = nextVertex(mesh);
  constexpr double kHigh = 0.8660254037844386;  // sin 60 deg
  for (const glm::dvec2& side : {glm::dvec2(1., 0.), glm::dvec2(-0.5, kHigh), glm::dvec2(-0.5, -kHigh)})
    mesh.vertices.emplace_back(foot.position + radius * (side.x * foot.right + side.y * foot.up()));
  mesh.vertices.emplace_back(foot.position + length * foot.along);
  for (std::uint32_t side = 0; side < 3; ++side)
    mesh.wood_triangles.push_back({first + side, first + (side + 1) % 3, first + 3});
}

void addLeaf(const WeberPenn& parameters, const LeafTemplates& templates, const Frame& foot, Random& random,
             TreeMesh& mesh) {
  const bool blossom = parameters.blossom_rate > 0.f && random.uniformDouble() < double{parameters.blossom_rate};
  double scale = double{blossom ? parameters.blossom_scale : parameters.leaf_scale};
  if (parameters.leaf_scale_v > 0.f) scale *= 1. + vary(random, double{parameters.leaf_scale_v});
  const double width = blossom ? 1. : double{parameters.leaf_scale_x};
  const LeafTemplate& shape = blossom ? templates.blossom : templates.leaf;
  glm::dvec3 base = foot.position;
  if (parameters.leaf_petiole > 0.f) {
    const double petiole = scale * double{parameters.leaf_petiole};
    addPetiole(foot, petiole, kPetioleRadius * scale, mesh);
    base += petiole * foot.along;
  }
  const glm::dvec3 length = scale * foot.along, half_width = 0.5 * scale * width * foot.right;
  const glm::dvec3 off = scale * foot.up();
  const std::uint32_t first = nextVertex(mesh);
  for (const glm::dvec3& v : shape.vertices)
    mesh.vertices.emplace_back(base + v.y * length + v.x * half_width + v.z * off);
  bool any = false;
  for (std::uint32_t i = 0; i < shape.triangles.size(); ++i) {
    const glm::uvec3 t = first + shape.triangles[i];
    if (!(triangleArea(mesh, t) > 0.)) continue;
    mesh.leaf_triangles.push_back(t);
    mesh.leaf_of_triangle.push_back(mesh.leaf_count);
    mesh.patch_of_triangle.push_back(blossom || !isUsable(shape.corners[i]) ? TreeMesh::kNoPatch : i);
    any = true;
  }
  mesh.leaf_count += any;
}

}  // namespace

LeafTemplates::LeafTemplates(const WeberPenn& p)
    : leaf(leafTemplate(p.leaf_shape, double{p.leaf_scale_x}, double{p.leaf_fold}, double{p.leaf_curl})),
      blossom(leafTemplate(p.blossom_shape, 1., double{p.leaf_fold}, double{p.leaf_curl})) {}

std::vector<LeafPatch> LeafTemplates::patches() const {
  std::vector<LeafPatch> all;
  for (const ImageCorners& corners : leaf.corners) all.push_back({.corners = corners});
  return all;
}

void placeLeaves(const WeberPenn& parameters, const LeafTemplates& templates, const Bud& twig, const Strand& strand,
                 int count, Random& random, TreeMesh& mesh) {
  const WeberPenn::Level& level = parameters.level[static_cast<std::size_t>(std::min(parameters.levels, 3))];
  const WeberPenn::Level& stem = parameters.level[static_cast<std::size_t>(twig.level)];
  const double bare = std::max(double{stem.base_size} * twig.length, strand.front().distance);
  Phyllotaxis phyllotaxis(level, random);
  for (int i = 1; i <= count; ++i) {
    const double share = double(i) / count;
    Frame leaf;
    if (parameters.leaves < 0) {
      leaf = frameAt(strand, twig.length);
      fanOut(leaf, level, (i - 0.5) / count, random);
    } else {
      leaf = frameAt(strand, bare + share * (twig.length - bare));
      phyllotaxis.direct(leaf, downAngle(level, 1. - share, random), random);
    }
    bendToLight(leaf, double{parameters.leaf_bend});
    addLeaf(parameters, templates, leaf, random, mesh);
  }
}

}  // namespace sunfleck::detail
