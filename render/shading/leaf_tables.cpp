#include "render/shading/leaf_tables.hpp"

#include <algorithm>
#include <cmath>

#include "render/shading/shading_data.hpp"
#include "scattering/gloss_tables.hpp"

namespace sunfleck::shading {
namespace {

using OfKind = LeafTables::OfKind;

bool glossy(const TreeKind& kind) {
  if (kind.maps) return kind.maps->glossy();
  return std::ranges::any_of(kind.leaf, [](const LeafOptics& of_band) { return of_band.gloss > 0.f; });
}

// Whether their triangles show the same parts of images, as those of turned trees do.
bool showTheSame(const std::shared_ptr<const TreeMesh>& a, const std::shared_ptr<const TreeMesh>& b) {
  if (a == b) return true;
  if (!a || !b) return false;
  return a->patch_of_triangle == b->patch_of_triangle &&
         std::ranges::equal(a->patches, b->patches, [](const LeafPatch& one, const LeafPatch& other) {
           return one.corners == other.corners && one.mask == other.mask;
         });
}

// Of kinds whose leaves show the same parts of images as large.
const OfKind* alike(std::span<const OfKind> kinds, const OfKind& kind) {
  const auto found = std::ranges::find_if(kinds, [&](const OfKind& other) {
    return other.pyramid && other.maps->width == kind.maps->width && other.maps->height == kind.maps->height &&
           showTheSame(other.mesh, kind.mesh);
  });
  return found == kinds.end() ? nullptr : &*found;
}

void addPyramid(LeafTables& tables, OfKind& kind, const LeafTables* before) {
  const OfKind* now = alike(tables.kinds, kind);
  const OfKind* then = before ? alike(before->kinds, kind) : nullptr;
  if (now) kind.shares = now->shares;
  if (!kind.shares && then) kind.shares = then->shares;
  if (!kind.shares)
    kind.shares = std::make_shared<const std::vector<float>>(
        leafAreaShares(kind.mesh ? *kind.mesh : TreeMesh{}, kind.maps->width, kind.maps->height));
  for (const OfKind& other : tables.kinds)
    if (other.pyramid && other.maps == kind.maps && other.shares == kind.shares) {
      kind.pyramid = other.pyramid;
      kind.first_place = other.first_place;
      return;
    }
  if (before)
    for (const OfKind& other : before->kinds)
      if (other.pyramid && other.maps == kind.maps && other.shares == kind.shares) kind.pyramid = other.pyramid;
  if (!kind.pyramid) kind.pyramid = std::make_shared<const LeafPyramid>(leafPyramid(*kind.maps, *kind.shares));
  kind.first_place = tables.places;
  tables.places += static_cast<std::uint32_t>(kind.pyramid->numbers.size() / kLeafPlaceGroups);
}

void addGlossTables(LeafTables& tables, OfKind& kind, const LeafTables* before) {
  for (const OfKind& other : tables.kinds)
    if (other.roughnesses == kind.roughnesses) {
      kind.first_table = other.first_table;
      return;
    }
  kind.first_table = static_cast<std::uint32_t>(tables.roughnesses.size());
  for (const float roughness : kind.roughnesses) {
    const auto known = before ? std::ranges::find(before->roughnesses, roughness) : tables.roughnesses.end();
    if (before && known != before->roughnesses.end()) {
      const auto first =
          before->gloss_tables.begin() + (known - before->roughnesses.begin()) * std::ptrdiff_t{kGlossTableNumbers};
      tables.gloss_tables.insert(tables.gloss_tables.end(), first, first + std::ptrdiff_t{kGlossTableNumbers});
    } else {
      const std::vector<float> table = glossTables(roughness);
      tables.gloss_tables.insert(tables.gloss_tables.end(), table.begin(), table.end());
    }
    tables.roughnesses.push_back(roughness);
  }
}

}  // namespace

std::shared_ptr<const LeafTables> leafTables(std::span<const TreeKind> kinds,
                                             const std::shared_ptr<const LeafTables>& before) {
  if (before && std::ranges::equal(kinds, before->kinds, [](const TreeKind& kind, const OfKind& of) {
        return kind.maps == of.maps && kind.leaf == of.leaf && (!kind.maps || kind.mesh == of.mesh);
      }))
    return before;
  LeafTables tables;
  for (const TreeKind& kind : kinds) {
    OfKind of{.leaf = kind.leaf, .maps = kind.maps};
    if (kind.maps) {
      of.mesh = kind.mesh;
      addPyramid(tables, of, before.get());
    }
    if (glossy(kind)) of.roughnesses = kind.maps ? kind.maps->roughnesses : std::vector{kind.leaf[0].gloss_roughness};
    addGlossTables(tables, of, before.get());
    tables.kinds.push_back(std::move(of));
  }
  return std::make_shared<const LeafTables>(std::move(tables));
}

std::size_t nearestRoughness(std::span<const float> roughnesses, float roughness) {
  const auto off = [&](float one) { return std::abs(one - roughness); };
  return static_cast<std::size_t>(std::ranges::min_element(roughnesses, {}, off) - roughnesses.begin());
}

}  // namespace sunfleck::shading
