#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "render/scene.hpp"
#include "render/shading/leaf_pyramid.hpp"

namespace sunfleck::shading {

// (R26, R37) What pictures read of leaves, whatever the model: the pyramids of their maps and the tables of their
// gloss.
struct LeafTables {
  struct OfKind {
    BandOptics leaf;  // the mean
    std::shared_ptr<const LeafMaps> maps;
    std::shared_ptr<const TreeMesh> mesh;              // of leaves with maps; of others none of the following
    std::shared_ptr<const std::vector<float>> shares;  // leafAreaShares()
    std::shared_ptr<const LeafPyramid> pyramid;        // kinds whose leaves show the same have the same
    std::uint32_t first_place = 0;                     // number of the pyramid's first among all kinds' places
    std::vector<float> roughnesses;                    // of the gloss; none where no leaf has one
    std::uint32_t first_table = 0;                     // of these
  };
  std::vector<OfKind> kinds;
  std::uint32_t places = 0;         // of all pyramids
  std::vector<float> roughnesses;   // of each table
  std::vector<float> gloss_tables;  // one after the other

  bool mapped() const { return places > 0; }
};

// Those of the kinds; `before` itself if nothing has changed, and else with all of it that serves.
std::shared_ptr<const LeafTables> leafTables(std::span<const TreeKind> kinds,
                                             const std::shared_ptr<const LeafTables>& before);

// Which of them is nearest.
std::size_t nearestRoughness(std::span<const float> roughnesses, float roughness);

}  // namespace sunfleck::shading
