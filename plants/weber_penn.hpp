#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/tree_mesh.hpp"
#include "plants/leaf_shape.hpp"

namespace sunfleck {

// The parameters of Weber & Penn 1995, "Creation and Rendering of Realistic Trees", SIGGRAPH, under the paper's names.
// Angles are in degrees and lengths in metres, as in the paper's tables. "+-v" is uniform in [-v, v]. Fields marked so
// come from tree-gen (Hewitt 2017, "Procedural generation of tree models for use in computer graphics") or are ours.
struct WeberPenn {
  // Crown shape: how the length of a branch follows from r, 0 at the crown's top and 1 at its base.
  enum class Shape {
    conical,
    spherical,
    hemispherical,
    cylindrical,
    tapered_cylindrical,
    flame,
    inverse_conical,
    tend_flame,
    envelope,
  };

  // Stems of one level: 0 the trunk, 1 the branches, 2 and 3 the twigs. The level after the last holds the leaves and
  // uses only the angles; of four levels of stems the last one's angles serve the leaves too.
  struct Level {
    float base_size = 0.f;   // bare share of the stem's length [1], 0 .. below 1 (paper: trunk only; tree-gen: all)
    float down_angle = 0.f;  // angle to the parent [deg]
    float down_angle_v =
        0.f;                 // >= 0: +-v; < 0: from down_angle + |v| at the parent's base to down_angle - 0.6 |v| [deg]
    float rotate = 0.f;      // >= 0: helix about the parent, step [deg]; < 0: alternate sides, offset [deg]
    float rotate_v = 0.f;    // +- [deg]
    int branches = 0;        // stems of this level on a full parent [1]; < 0: a fan of |branches| at its tip, spread
                             // over `rotate`; -1000 .. 1000
    float length = 0.f;      // share of the parent's length [1], 0 .. 5
    float length_v = 0.f;    // +- [1]
    float taper = 1.f;       // 0 cylinder, 1 cone, 2 cylinder with round end, 3 beads [1]
    float seg_splits = 0.f;  // splits per segment of a whole stem [1], 0 .. 10
    float split_angle = 0.f;    // [deg]
    float split_angle_v = 0.f;  // +- [deg]
    int curve_res = 1;          // segments [1], 1 .. 100
    float curve = 0.f;          // turn from base to tip, or to the middle when curve_back is not 0; < 0 is upward [deg]
    float curve_back = 0.f;     // turn from the middle to the tip [deg]
    float curve_v = 0.f;  // random turn over the whole stem, in the plane of the curve, +- [deg]; < 0: the stem is
                          // a helix at |curve_v| to its axis, a turn every four segments, -89 .. 720
    float bend_v = 0.f;   // the same across that plane (tree-gen), +- [deg], >= 0
  };

  Shape shape = Shape::spherical;
  float scale = 10.f;         // height of the tree [m], > 0
  float scale_v = 0.f;        // +- [m], below scale
  int levels = 3;             // of stems [1], 1 .. 4, the trunk being one; leaves stand on the last
  float ratio = 0.015f;       // radius of the trunk over its length [1], > 0
  float ratio_power = 1.2f;   // radius of a child: parent's times (length over parent's length)^ratio_power [1], >= 0
  int lobes = 0;              // bulges around the trunk [1], 0 .. 16
  float lobe_depth = 0.f;     // their height over the radius [1], 0 .. below 1
  float flare = 0.f;          // widening of the trunk at the ground: radius times 1 + flare [1], >= 0
  float scale_0 = 1.f;        // 0Scale: extra scale of the trunk's radius [1], > 0
  float scale_v_0 = 0.f;      // 0ScaleV, +- [1], below scale_0
  int base_splits = 0;        // splits at the end of the trunk's first segment [1]; < 0: at random from 0 to
                              // |base_splits| (tree-gen); -10 .. 10
  float attraction_up = 0.f;  // upward growth of levels 2 and beyond; < 0: drooping [1], -10 .. 10

  int leaves = 0;            // leaves on a full twig [1]; < 0: a fan of |leaves| at its tip; -1000 .. 1000
  float leaf_scale = 0.1f;   // length of a leaf [m], > 0
  float leaf_scale_x = 1.f;  // its width over its length [1], > 0
  float leaf_bend = 0.f;     // turn of leaves to the light: 0 none, 1 face outward and up [1], 0 .. 1
  LeafShape leaf_shape = LeafShape::rectangle;
  float leaf_scale_v = 0.f;     // +- share of the length [1] (ours), 0 .. 0.95
  float leaf_petiole = 0.f;     // length of its stalk over that of the leaf [1], 0 .. 5; thin wood (ours)
  float leaf_fold = 0.f;        // how much the halves are lifted from the plane, together [deg] (ours), -90 .. 90
  float leaf_curl = 0.f;        // bend from base to tip, > 0 downward [deg] (ours), -180 .. 180
  float blossom_rate = 0.f;     // share of leaves that are blossoms instead [1] (tree-gen), 0 .. 1
  float blossom_scale = 0.03f;  // length of a blossom [m], > 0; as wide as long
  LeafShape blossom_shape = LeafShape::blossom;

  float prune_ratio = 0.f;        // 0: no pruning, 1: stems end inside the envelope [1], 0 .. 1
  float prune_width = 0.5f;       // envelope's largest radius over the tree's height [1], > 0
  float prune_width_peak = 0.5f;  // height of the widest place in the crown, from its base [1], 0 .. 1
  float prune_power_low = 0.5f;   // curve of the envelope below it [1], >= 0
  float prune_power_high = 0.5f;  // and above it [1], >= 0

  std::array<Level, 4> level;
};

// Throws InvalidInput("WeberPenn.<field> = <value>: must be <rule>").
void validate(const WeberPenn& parameters);

// A tree in metres, z up, the trunk's foot at the origin. Trunk, branches and twigs are closed-tipped tubes, petioles
// wood as well; leaves have the outline of their shape and stand on a twig with their base or their petiole. The same
// parameters and seed give the same bytes, on any machine and for any number of threads. Throws InvalidInput on
// parameters out of range, without leaves, for more than 100 M vertices or 20 M stems.
TreeMesh grow(const WeberPenn& parameters, std::uint64_t seed);

}  // namespace sunfleck
