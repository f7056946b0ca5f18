#pragma once

#include <string>
#include <type_traits>

#include "plants/weber_penn.hpp"

namespace sunfleck::detail {

// Calls visit(table, key, value, least, most) for every parameter of a tree: the table and the key that it has in a
// parameter file, and the range of numbers. Bounds that hang on another parameter come after it.
template <typename Parameters, typename Visit>
void eachField(Parameters& p, const Visit& visit) {
  constexpr float kTallest = 1000.f;  // [m]; no tree is taller
  visit("tree", "shape", p.shape, 0.f, 0.f);
  visit("tree", "scale", p.scale, 0.01f, kTallest);
  visit("tree", "scale_v", p.scale_v, 0.f, 0.95f * p.scale);
  visit("tree", "levels", p.levels, 1.f, 4.f);
  visit("tree", "ratio", p.ratio, 1e-6f, 1.f);
  visit("tree", "ratio_power", p.ratio_power, 0.f, 10.f);
  visit("tree", "lobes", p.lobes, 0.f, 16.f);
  visit("tree", "lobe_depth", p.lobe_depth, 0.f, 0.99f);
  visit("tree", "flare", p.flare, 0.f, 10.f);
  visit("tree", "scale_0", p.scale_0, 1e-3f, 100.f);
  visit("tree", "scale_v_0", p.scale_v_0, 0.f, 0.95f * p.scale_0);
  visit("tree", "base_splits", p.base_splits, -10.f, 10.f);
  visit("tree", "attraction_up", p.attraction_up, -10.f, 10.f);
  visit("leaves", "leaves", p.leaves, -1000.f, 1000.f);
  visit("leaves", "leaf_scale", p.leaf_scale, 1e-4f, 100.f);
  visit("leaves", "leaf_scale_x", p.leaf_scale_x, 1e-3f, 1000.f);
  visit("leaves", "leaf_bend", p.leaf_bend, 0.f, 1.f);
  visit("leaves", "leaf_shape", p.leaf_shape, 0.f, 0.f);
  visit("leaves", "leaf_scale_v", p.leaf_scale_v, 0.f, 0.95f);
  visit("leaves", "leaf_petiole", p.leaf_petiole, 0.f, 5.f);
  visit("leaves", "leaf_fold", p.leaf_fold, -90.f, 90.f);
  visit("leaves", "leaf_curl", p.leaf_curl, -180.f, 180.f);
  visit("leaves", "blossom_rate", p.blossom_rate, 0.f, 1.f);
  visit("leaves", "blossom_scale", p.blossom_scale, 1e-4f, 100.f);
  visit("leaves", "blossom_shape", p.blossom_shape, 0.f, 0.f);
  visit("pruning", "prune_ratio", p.prune_ratio, 0.f, 1.f);
  visit("pruning", "prune_width", p.prune_width, 1e-3f, 10.f);
  visit("pruning", "prune_width_peak", p.prune_width_peak, 0.f, 1.f);
  visit("pruning", "prune_power_low", p.prune_power_low, 0.f, 100.f);
  visit("pruning", "prune_power_high", p.prune_power_high, 0.f, 100.f);
  for (std::size_t n = 0; n < p.level.size(); ++n) {
    auto& level = p.level[n];
    const std::string table = "level" + std::to_string(n);
    visit(table, "base_size", level.base_size, 0.f, 0.99f);
    visit(table, "down_angle", level.down_angle, -360.f, 360.f);
    visit(table, "down_angle_v", level.down_angle_v, -360.f, 360.f);
    visit(table, "rotate", level.rotate, -360.f, 360.f);
    visit(table, "rotate_v", level.rotate_v, -360.f, 360.f);
    visit(table, "branches", level.branches, -1000.f, 1000.f);
    visit(table, "length", level.length, 0.f, 5.f);
    visit(table, "length_v", level.length_v, 0.f, 5.f);
    visit(table, "taper", level.taper, 0.f, 3.f);
    visit(table, "seg_splits", level.seg_splits, 0.f, 10.f);
    visit(table, "split_angle", level.split_angle, 0.f, 180.f);
    visit(table, "split_angle_v", level.split_angle_v, 0.f, 180.f);
    visit(table, "curve_res", level.curve_res, 1.f, 100.f);
    visit(table, "curve", level.curve, -720.f, 720.f);
    visit(table, "curve_back", level.curve_back, -720.f, 720.f);
    visit(table, "curve_v", level.curve_v, -89.f, 720.f);
    visit(table, "bend_v", level.bend_v, 0.f, 720.f);
  }
}

}  // namespace sunfleck::detail
