#include "plants/detail/assemble.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "core/bounds.hpp"
#include "core/finished_mesh.hpp"
#include "core/require.hpp"
#include "plants/detail/cut_cards.hpp"
#include "plants/detail/leaf_grouping.hpp"
#include "plants/detail/shared_patches.hpp"

namespace sunfleck::detail {
namespace {

// Smaller ones drown in the lengths that keep rays and maps from dividing by nothing, up to 1e-6 m.
constexpr float kSmallestTree = 1e-4f;  // [m]

// What becomes of the leaf triangles of a material.
struct Treatment {
  bool left_out = false;
  std::uint32_t mask = LeafPatch::kNoMask;
};

// Opacities by material, whose images are read once.
class Treatments {
 public:
  Treatments(const ImportRules& rules, const ImageReader& read_image, const std::string& source, TreeMesh& mesh)
      : rules_(rules), read_image_(read_image), source_(source), mesh_(mesh) {}

  Treatment of(const Opacity& opacity) {
    const auto [known, is_new] = known_.try_emplace(&opacity);
    if (is_new) known->second = decide(opacity);
    return known->second;
  }

 private:
  Treatment decide(const Opacity& opacity) {
    if (opacity.image.empty()) return {.left_out = opacity.factor < opacity.least};
    if (rules_.cards == ImportRules::Cards::whole) return {};
    const auto [known, is_new] = masks_.try_emplace(
        {opacity.image.string(), opacity.bytes.data(), opacity.factor, opacity.least, opacity.by_alpha, opacity.moved},
        LeafPatch::kNoMask);
    if (!is_new) return {.mask = known->second};
    const std::shared_ptr<const LeafMask> mask = maskOf(opacity, read_image_, source_);
    if (!mask) return {};
    known->second = static_cast<std::uint32_t>(mesh_.masks.size());
    mesh_.masks.push_back(mask);
    return {.mask = known->second};
  }

  const ImportRules& rules_;
  const ImageReader& read_image_;
  const std::string& source_;
  TreeMesh& mesh_;
  std::map<const Opacity*, Treatment> known_;
  // Of images, which several materials may share.
  std::map<std::tuple<std::string, const char*, float, float, bool, bool>, std::uint32_t> masks_;
};

ImageCorners cornersOf(const NamedTriangles& faces, std::size_t triangle) {
  ImageCorners corners;
  corners.fill(glm::vec2(std::numeric_limits<float>::quiet_NaN()));
  if (faces.texture_corners.empty()) return corners;
  for (int c = 0; c < 3; ++c)
    if (const std::uint32_t at = faces.texture_corners[triangle][c]; at < faces.texture.size())
      corners[static_cast<std::size_t>(c)] = faces.texture[at];
  return corners;
}

// To a leaf triangle just added.
void addPatch(TreeMesh& mesh, SharedPatches& patches, const NamedTriangles& faces, std::size_t triangle,
              std::uint32_t mask, const std::string& source) {
  if (faces.texture_corners.empty() && mesh.masks.empty()) return;
  const ImageCorners corners = cornersOf(faces, triangle);
  const bool all = std::ranges::none_of(corners, [](const glm::vec2& c) { return std::isnan(c.x + c.y); });
  if (mask != LeafPatch::kNoMask && !all)
    require(false,
            source + ": leaf triangle " + std::to_string(mesh.patch_of_triangle.size() + 1) + ": texture coordinates",
            "(missing)", "there, as its material has a mask (or --cards whole)");
  const bool known = mask != LeafPatch::kNoMask || isUsable(corners);
  mesh.patch_of_triangle.push_back(known ? patches.numberOf({corners, mask}) : TreeMesh::kNoPatch);
}

void toMetresZUp(std::vector<glm::vec3>& vertices, const ImportRules& rules, bool format_y_up) {
  using Up = ImportRules::Up;
  const Up up = rules.up != Up::of_format ? rules.up : format_y_up ? Up::y : Up::z;
  for (glm::vec3& v : vertices) {
    if (up == Up::y) v = {v.x, -v.z, v.y};
    if (up == Up::x) v = {v.y, v.z, v.x};
    v *= rules.scale;
  }
}

double areaOfCards(const TreeMesh& mesh) {
  double area = 0.;
  for (std::size_t i = 0; i < mesh.leaf_triangles.size(); ++i)
    if (isCut(mesh, i)) area += triangleArea(mesh, mesh.leaf_triangles[i]);
  return area;
}

}  // namespace

ImportedTree assemble(NamedTriangles faces, const Verdict& verdict, const ImportRules& rules,
                      const ImageReader& read_image, const std::string& source) {
  ImportedTree tree;
  tree.how = verdict.how;
  tree.mesh.vertices = std::move(faces.vertices);
  Treatments treatments(rules, read_image, source, tree.mesh);
  std::vector<Treatment> of_part(faces.parts.size());
  for (std::size_t part = 0; part < of_part.size(); ++part)
    if (faces.parts[part].opacity && verdict.kinds[part] == Kind::leaf)
      of_part[part] = treatments.of(*faces.parts[part].opacity);
  SharedPatches patches(tree.mesh.patches);
  std::size_t left_out = 0;
  std::array<std::size_t, 2> count{};
  for (const std::uint32_t part : faces.part_of_triangle) ++count[verdict.kinds[part] == Kind::leaf ? 0 : 1];
  tree.mesh.leaf_triangles.reserve(count[0]);
  tree.mesh.wood_triangles.reserve(count[1]);
  for (std::size_t i = 0; i < faces.triangles.size(); ++i) {
    const std::uint32_t part = faces.part_of_triangle[i];
    if (verdict.kinds[part] == Kind::wood) {
      tree.mesh.wood_triangles.push_back(faces.triangles[i]);
    } else if (of_part[part].left_out) {
      ++left_out;
    } else {
      tree.mesh.leaf_triangles.push_back(faces.triangles[i]);
      addPatch(tree.mesh, patches, faces, i, of_part[part].mask, source);
    }
  }
  if (left_out > 0) tree.how += "; left out " + std::to_string(left_out) + " leaf triangles of transparent materials";
  return tree;
}

void complete(ImportedTree& tree, const ImportRules& rules, bool format_y_up, const std::string& source) {
  TreeMesh& mesh = tree.mesh;
  toMetresZUp(mesh.vertices, rules, format_y_up);
  requireVertices(mesh, source);
  const std::size_t doubled = groupLeaves(mesh);
  const bool cards = !mesh.masks.empty();
  tree.card_area = areaOfCards(mesh);
  double others = 0.;  // area of leaves that no mask cuts [m^2]
  for (std::size_t i = 0; cards && i < mesh.leaf_triangles.size(); ++i)
    if (!isCut(mesh, i)) others += triangleArea(mesh, mesh.leaf_triangles[i]);
  if (cards && rules.cards == ImportRules::Cards::cut) {
    cutCards(mesh, source);
    tree.how += "; leaves are cut out of cards";
  } else if (cards) {
    tree.how += "; leaves are cut out by masks";
  }
  tree.dropped = finish(mesh, source);
  tree.dropped.doubled = doubled;
  if (cards) tree.cut_area = leafArea(mesh) - others;
  const glm::vec3 size = bounds(mesh).size();
  const float longest = std::max({size.x, size.y, size.z});
  require(longest >= kSmallestTree, source + ": size of the tree [m]", longest, "at least 1e-4; is the scale right?");
}

}  // namespace sunfleck::detail
