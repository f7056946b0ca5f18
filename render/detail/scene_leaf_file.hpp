#pragma once

#include "leaves/light_bands.hpp"
#include "render/detail/scene_table.hpp"
#include "render/scene.hpp"

namespace sunfleck::detail {

// What the bands of leaves that are told by species or contents are, by bands_nm of [leaf].
LightBands readLightBands(SceneTable& leaf);

// Whether the table tells reflectance or transmittance of leaves, in any way.
bool tellsLeafShares(const SceneTable& table, const std::string& prefix);

// Reflectance and transmittance of leaves: those of the table, as numbers, by species and contents, or as a slab of
// tissue, under keys with `prefix` before them, or else those that `leaf` and `optics` have already. Throws
// InvalidInput as readScene() does, and on a table that tells them in two ways.
void readLeafShares(SceneTable& table, const std::string& prefix, const LightBands& bands, LeafDescription& leaf,
                    BandOptics& optics);

// Optics of leaves and wood and textures: those of the tables, or else those that the kind has already. What follows
// from textures is for setLeaves() to say.
void readOptics(TreeKind& kind, SceneTable& leaf, const std::string& leaf_prefix, SceneTable& wood,
                const std::string& wood_prefix, const LightBands& bands);

}  // namespace sunfleck::detail
