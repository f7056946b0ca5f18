#include "plants/species.hpp"

#include <map>

#include "core/require.hpp"

// Sources. [WP] J. Weber, J. Penn 1995, "Creation and Rendering of Realistic Trees", SIGGRAPH, appendix. [AR] arbaro,
// by W. Diestel, trees/*.xml, the paper's tables completed. [TG] tree-gen, by C. Hewitt 2017,
// parametric/tree_params/*.py. [BS] Blender's Sapling add-on, presets. Where a value is ours, the species says so.
namespace sunfleck {
namespace {

using Shape = WeberPenn::Shape;

// Hill cherry in blossom, after [TG] hill_cherry, made a young tree. Ours ([TG] in brackets): scale 5.2 +- 0.3 (13 +-
// 3), ratio 0.02 (0.015), base_splits 1 (0 to 2), splits of the trunk 0.3 (0.5) and its random turns 75 (150), 12 twigs
// (18), random turns across of twigs 150 (250), 10 blossoms a twig (25), attraction -0.15 (a tropism of its own). A
// leaf is a blossom cluster, a square of 9 cm, so that 9,000 of them (18,000 triangles, as the cherry of the SPPG
// paper's Table 3 has) fill the crown as a flowering cherry's do.
WeberPenn cherry() {
  WeberPenn p;
  p.shape = Shape::hemispherical;
  p.scale = 5.2f;
  p.scale_v = 0.3f;
  p.levels = 3;
  p.ratio = 0.02f;
  p.ratio_power = 1.3f;
  p.flare = 0.6f;
  p.base_splits = 1;
  p.attraction_up = -0.15f;
  p.leaves = 10;
  p.leaf_scale = 0.09f;
  p.leaf_scale_x = 1.f;
  p.prune_ratio = 1.f;
  p.prune_width = 0.7f;
  p.prune_width_peak = 0.5f;
  p.prune_power_low = 0.2f;
  p.prune_power_high = 0.5f;
  p.level = {{
      {.base_size = 0.15f,
       .length = 0.8f,
       .seg_splits = 0.3f,
       .split_angle = 40.f,
       .split_angle_v = 5.f,
       .curve_res = 10,
       .curve = 30.f,
       .curve_back = -40.f,
       .curve_v = 75.f,
       .bend_v = 75.f},
      {.base_size = 0.02f,
       .down_angle = 70.f,
       .down_angle_v = 10.f,
       .rotate = 140.f,
       .branches = 25,
       .length = 0.5f,
       .seg_splits = 0.3f,
       .split_angle = 40.f,
       .split_angle_v = 5.f,
       .curve_res = 5,
       .curve = -20.f,
       .curve_back = 40.f,
       .curve_v = 150.f,
       .bend_v = 150.f},
      {.base_size = 0.02f,
       .down_angle = 60.f,
       .down_angle_v = 20.f,
       .rotate = 140.f,
       .branches = 12,
       .length = 0.6f,
       .length_v = 0.1f,
       .curve_res = 8,
       .curve = -40.f,
       .curve_v = 150.f,
       .bend_v = 150.f},
      {.down_angle = 45.f, .down_angle_v = 30.f, .rotate = 77.f},
  }};
  return p;
}

// Japanese maple, after [TG] acer. Ours ([TG] in brackets): scale 6 +- 0.5 as in [BS] japanese_maple (10 +- 1),
// base_splits 2 (0 to 2), base_size 0.2 and 0.2 (0.1 and 0.4), 12 branches (6) of length 0.5 (0.7) with 1 split per
// segment (1.5), 14 twigs (20) of length 0.35 (0.3) with random turns across, and 16 leaves (30) of 6.5 cm (20 cm).
WeberPenn maple() {
  WeberPenn p;
  p.shape = Shape::tapered_cylindrical;
  p.scale = 6.f;
  p.scale_v = 0.5f;
  p.levels = 3;
  p.ratio = 0.025f;
  p.ratio_power = 1.5f;
  p.flare = 0.6f;
  p.base_splits = 2;
  p.leaves = 16;
  p.leaf_scale = 0.065f;
  p.leaf_scale_x = 1.f;
  p.leaf_bend = 0.3f;
  p.level = {{
      {.base_size = 0.2f,
       .length = 1.f,
       .seg_splits = 1.5f,
       .split_angle = 50.f,
       .split_angle_v = 5.f,
       .curve_res = 6,
       .curve_v = 200.f},
      {.base_size = 0.2f,
       .down_angle = 50.f,
       .down_angle_v = 5.f,
       .rotate = 140.f,
       .branches = 12,
       .length = 0.5f,
       .length_v = 0.05f,
       .seg_splits = 1.f,
       .split_angle = 50.f,
       .split_angle_v = 5.f,
       .curve_res = 5,
       .curve_v = 100.f,
       .bend_v = 50.f},
      {.base_size = 0.02f,
       .down_angle = 50.f,
       .down_angle_v = 5.f,
       .rotate = 140.f,
       .branches = 14,
       .length = 0.35f,
       .length_v = 0.05f,
       .curve_res = 3,
       .curve_v = 100.f,
       .bend_v = 100.f},
      {.down_angle = 45.f, .down_angle_v = 10.f, .rotate = 77.f},
  }};
  return p;
}

// Quaking aspen, as [WP] and [AR] have it. Ours: leaves of 8 cm, as the tree has them (17 cm there).
WeberPenn quakingAspen() {
  WeberPenn p;
  p.shape = Shape::tend_flame;
  p.scale = 13.f;
  p.scale_v = 3.f;
  p.levels = 3;
  p.ratio = 0.015f;
  p.ratio_power = 1.2f;
  p.lobes = 5;
  p.lobe_depth = 0.07f;
  p.flare = 0.6f;
  p.scale_v_0 = 0.2f;
  p.attraction_up = 0.5f;
  p.leaves = 25;
  p.leaf_scale = 0.08f;
  p.leaf_bend = 0.3f;
  p.level = {{
      {.base_size = 0.4f, .length = 1.f, .curve_res = 3, .curve_v = 20.f},
      {.down_angle = 60.f,
       .down_angle_v = -50.f,
       .rotate = 140.f,
       .branches = 50,
       .length = 0.3f,
       .curve_res = 5,
       .curve = -40.f,
       .curve_v = 50.f},
      {.down_angle = 45.f,
       .down_angle_v = 10.f,
       .rotate = 140.f,
       .branches = 30,
       .length = 0.6f,
       .curve_res = 3,
       .curve = -40.f,
       .curve_v = 75.f},
      {.down_angle = 45.f, .down_angle_v = 10.f, .rotate = 77.f},
  }};
  return p;
}

// California black oak, as [WP] and [AR] have it. Ours ([AR] in brackets), so that its leaf area is 7 and not 38 times
// its ground: scale_v 2 as in [TG] (10, which lets a tree have no height), 24 branches (40), 40 twigs (120) of length
// 0.3 as in [TG] (0.2), 15 leaves (25).
WeberPenn blackOak() {
  WeberPenn p;
  p.shape = Shape::hemispherical;
  p.scale = 10.f;
  p.scale_v = 2.f;
  p.levels = 3;
  p.ratio = 0.018f;
  p.ratio_power = 1.3f;
  p.lobes = 5;
  p.lobe_depth = 0.1f;
  p.flare = 1.2f;
  p.base_splits = 2;
  p.attraction_up = 0.8f;
  p.leaves = 15;
  p.leaf_scale = 0.12f;
  p.leaf_scale_x = 0.66f;
  p.leaf_bend = 0.3f;
  p.level = {{
      {.base_size = 0.05f,
       .length = 1.f,
       .taper = 0.95f,
       .seg_splits = 0.4f,
       .split_angle = 10.f,
       .curve_res = 8,
       .curve_v = 90.f},
      {.down_angle = 30.f,
       .down_angle_v = -30.f,
       .rotate = 80.f,
       .branches = 24,
       .length = 0.8f,
       .length_v = 0.1f,
       .seg_splits = 0.2f,
       .split_angle = 10.f,
       .split_angle_v = 10.f,
       .curve_res = 10,
       .curve = 40.f,
       .curve_back = -70.f,
       .curve_v = 150.f},
      {.down_angle = 45.f,
       .down_angle_v = 10.f,
       .rotate = 140.f,
       .branches = 40,
       .length = 0.3f,
       .length_v = 0.05f,
       .seg_splits = 0.1f,
       .split_angle = 10.f,
       .split_angle_v = 10.f,
       .curve_res = 3,
       .curve = -40.f,
       .curve_v = 30.f},
      {.down_angle = 45.f, .down_angle_v = 10.f, .rotate = 140.f},
  }};
  return p;
}

const std::map<std::string, WeberPenn>& all() {
  static const std::map<std::string, WeberPenn> species{
      {"black_oak", blackOak()}, {"cherry", cherry()}, {"maple", maple()}, {"quaking_aspen", quakingAspen()}};
  return species;
}

}  // namespace

std::vector<std::string> speciesNames() {
  std::vector<std::string> names;
  for (const auto& [name, parameters] : all()) names.push_back(name);
  return names;
}

const WeberPenn& species(const std::string& name) {
  const auto found = all().find(name);
  if (found != all().end()) return found->second;
  std::string names;
  for (const std::string& known : speciesNames()) names += (names.empty() ? "" : ", ") + known;
  require(false, "species", name, "one of " + names);
  return found->second;
}

}  // namespace sunfleck
