#include "plants/weber_penn.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/require.hpp"
#include "plants/detail/budding.hpp"
#include "plants/detail/leaf_placement.hpp"
#include "plants/detail/pruning.hpp"
#include "plants/detail/stem.hpp"
#include "plants/detail/tube.hpp"

namespace sunfleck {
namespace {

using namespace detail;

constexpr std::size_t kMostVertices = 100'000'000;

// How a stem hangs on its parent.
struct Parentage {
  double parent_length;  // [m]
  double offset_share;   // where on the parent, over its length [1]
  double full_length;    // the stem's length over its parent's before the crown's shape shortens it [1]
};

class Grower {
 public:
  Grower(const WeberPenn& parameters, std::uint64_t seed) : parameters_(parameters), seed_(seed) {}

  TreeMesh tree() {
    Random random = nextStream();
    height_ = double{parameters_.scale} + vary(random, double{parameters_.scale_v});
    const WeberPenn::Level& trunk = parameters_.level[0];
    Bud bud;
    bud.length = height_ * std::max(0.05, double{trunk.length} + vary(random, double{trunk.length_v}));
    bud.radius = bud.length * double{parameters_.ratio} *
                 (double{parameters_.scale_0} + vary(random, double{parameters_.scale_v_0}));
    bud.base.turn(bud.base.along, 2. * std::numbers::pi * random.uniformDouble());
    stem(bud, {.parent_length = bud.length, .offset_share = 1., .full_length = 1.});
    finish(mesh_, "tree");
    return std::move(mesh_);
  }

 private:
  Random nextStream() { return Random(seed_, next_stream_++); }

  void stem(Bud bud, const Parentage& parentage) {
    Random random = nextStream();
    const std::vector<Strand> strands = prunedStrands(bud, random);
    if (strands.empty()) return;
    for (const Strand& strand : strands) addTube(parameters_, bud, strand, mesh_);
    const bool last = bud.level + 1 == parameters_.levels;
    const double children = last ? leavesOn(parentage) : stemsOn(bud, parentage);
    for (const Strand& strand : strands) {
      if (last)
        placeLeaves(parameters_, bud, strand, wholeLeaves(children * shareOf(bud, strand)), random, mesh_);
      else
        branch(bud, strand, children, random);
    }
    require(mesh_.vertices.size() <= kMostVertices, "WeberPenn: vertices of the tree", mesh_.vertices.size(),
            "at most 100000000");
  }

  // Grows the stem and shortens it until it stays above the ground, and then, by prune_ratio, inside the pruning
  // envelope; empty when nothing is left of it. The ground is ours: drooping branches of the paper would grow into it.
  std::vector<Strand> prunedStrands(Bud& bud, Random& random) {
    const Random before = random;
    const SplitDebt debt_before = split_debt_;
    std::vector<Strand> strands = growStem(parameters_, bud, split_debt_, random);
    if (bud.level == 0) return strands;
    const auto regrow = [&](double length) {
      bud.length = length;
      random = before;
      split_debt_ = debt_before;
      strands = growStem(parameters_, bud, split_debt_, random);
    };
    const auto shorten = [&](const auto& fits) {
      const double full = bud.length;
      while (!fits(strands) && bud.length > 0.05 * full) regrow(0.9 * bud.length);
      return fits(strands) ? bud.length : 0.;
    };
    if (shorten([&](const auto& grown) { return aboveGround(grown); }) == 0.) return {};
    if (parameters_.prune_ratio > 0.f) {
      const double full = bud.length;
      const double fitting = shorten([&](const auto& grown) { return insideEnvelope(grown); });
      const double ratio = double{parameters_.prune_ratio};
      const double length = ratio * fitting + (1. - ratio) * full;
      if (length < 0.05 * full) return {};
      if (length != bud.length) regrow(length);
    }
    return strands;
  }

  template <typename Test>
  static bool everywhere(const std::vector<Strand>& strands, const Test& test) {
    return std::all_of(strands.begin(), strands.end(), [&](const Strand& strand) {
      return std::all_of(strand.begin(), strand.end(), [&](const Station& s) { return test(s.frame.position); });
    });
  }
  bool aboveGround(const std::vector<Strand>& strands) const {
    return everywhere(strands, [&](const glm::dvec3& p) { return p.z >= double{parameters_.leaf_scale}; });
  }
  bool insideEnvelope(const std::vector<Strand>& strands) const {
    return everywhere(strands, [&](const glm::dvec3& p) { return detail::insideEnvelope(parameters_, height_, p); });
  }

  static double shareOf(const Bud& bud, const Strand& strand) {
    return (bud.length - strand.front().distance) / bud.length;
  }

  double leavesOn(const Parentage& parentage) const {
    return parameters_.leaves * shapeRatio(WeberPenn::Shape::tapered_cylindrical, parentage.offset_share);
  }

  int wholeLeaves(double wanted) {
    const int whole = std::max(0, static_cast<int>(std::lround(wanted + leaf_debt_)));
    leaf_debt_ += wanted - whole;
    return whole;
  }

  // Number of children a stem would bear along its whole length.
  double stemsOn(const Bud& bud, const Parentage& parentage) const {
    const double most = parameters_.level[static_cast<std::size_t>(bud.level) + 1].branches;
    if (bud.level == 0) return most;
    if (bud.level == 1)
      return most * std::min(1., 0.2 + 0.8 * (bud.length / parentage.parent_length) / parentage.full_length);
    return most * (1. - 0.5 * parentage.offset_share);
  }

  void branch(const Bud& parent, const Strand& strand, double stems, Random& random) {
    const WeberPenn::Level& level = parameters_.level[static_cast<std::size_t>(parent.level) + 1];
    const double bare = double{parameters_.level[static_cast<std::size_t>(parent.level)].base_size} * parent.length;
    if (stems < 0.01) return;
    const double spacing = (parent.length - bare) / stems;
    Phyllotaxis phyllotaxis(level, random);
    const double first = bare + spacing * random.uniformDouble();
    for (double offset = first; offset < parent.length; offset += spacing) {
      if (offset < strand.front().distance) continue;
      const double towards_base = (parent.length - offset) / (parent.length - bare);
      const double full = std::max(0.02, double{level.length} + vary(random, double{level.length_v}));
      Bud child{.base = frameAt(strand, offset), .level = parent.level + 1};
      phyllotaxis.direct(child.base, downAngle(level, towards_base, random), random);
      child.length =
          parent.level == 0 ? parent.length * full * crownShape(towards_base) : full * (parent.length - 0.6 * offset);
      child.radius = std::min(parent.radius * std::pow(child.length / parent.length, double{parameters_.ratio_power}),
                              radiusAt(parameters_, parent, offset / parent.length));
      if (child.length > 1e-3 * height_)
        stem(child, {.parent_length = parent.length, .offset_share = offset / parent.length, .full_length = full});
    }
  }

  double crownShape(double towards_base) const {
    return parameters_.shape == WeberPenn::Shape::envelope ? envelopeWidth(parameters_, towards_base)
                                                           : shapeRatio(parameters_.shape, towards_base);
  }

  const WeberPenn& parameters_;
  std::uint64_t seed_;
  std::uint64_t next_stream_ = 0;  // a stream of random numbers for every stem
  double height_ = 0.;             // of this tree: scale +- scale_v [m]
  SplitDebt split_debt_{};
  double leaf_debt_ = 0.;  // leaves that rounding owes to the next twig
  TreeMesh mesh_;
};

void check(const std::string& field, float value, float least, float most) {
  std::ostringstream rule;
  rule << "in [" << least << ", " << most << "]";
  require(value >= least && value <= most, "WeberPenn." + field, value, rule.str());
}

void checkLevel(const WeberPenn::Level& level, const std::string& name) {
  check(name + "base_size", level.base_size, 0.f, 0.99f);
  check(name + "down_angle", level.down_angle, -360.f, 360.f);
  check(name + "down_angle_v", level.down_angle_v, -360.f, 360.f);
  check(name + "rotate", level.rotate, -360.f, 360.f);
  check(name + "rotate_v", level.rotate_v, -360.f, 360.f);
  check(name + "branches", static_cast<float>(level.branches), 0.f, 1000.f);
  check(name + "length", level.length, 0.f, 5.f);
  check(name + "length_v", level.length_v, 0.f, 5.f);
  check(name + "taper", level.taper, 0.f, 3.f);
  check(name + "seg_splits", level.seg_splits, 0.f, 10.f);
  check(name + "split_angle", level.split_angle, 0.f, 180.f);
  check(name + "split_angle_v", level.split_angle_v, 0.f, 180.f);
  check(name + "curve_res", static_cast<float>(level.curve_res), 1.f, 100.f);
  check(name + "curve", level.curve, -720.f, 720.f);
  check(name + "curve_back", level.curve_back, -720.f, 720.f);
  check(name + "curve_v", level.curve_v, 0.f, 720.f);
  check(name + "bend_v", level.bend_v, 0.f, 720.f);
}

}  // namespace

void validate(const WeberPenn& p) {
  constexpr float kTallest = 1000.f;  // [m]; no tree is taller
  check("scale", p.scale, 0.01f, kTallest);
  check("scale_v", p.scale_v, 0.f, 0.95f * p.scale);
  check("levels", static_cast<float>(p.levels), 1.f, 3.f);
  check("ratio", p.ratio, 1e-6f, 1.f);
  check("ratio_power", p.ratio_power, 0.f, 10.f);
  check("lobes", static_cast<float>(p.lobes), 0.f, 16.f);
  check("lobe_depth", p.lobe_depth, 0.f, 0.99f);
  check("flare", p.flare, 0.f, 10.f);
  check("scale_0", p.scale_0, 1e-3f, 100.f);
  check("scale_v_0", p.scale_v_0, 0.f, 0.95f * p.scale_0);
  check("base_splits", static_cast<float>(p.base_splits), 0.f, 10.f);
  check("attraction_up", p.attraction_up, -10.f, 10.f);
  check("leaves", static_cast<float>(p.leaves), 0.f, 1000.f);
  check("leaf_scale", p.leaf_scale, 1e-4f, 100.f);
  check("leaf_scale_x", p.leaf_scale_x, 1e-3f, 1000.f);
  check("leaf_bend", p.leaf_bend, 0.f, 1.f);
  check("prune_ratio", p.prune_ratio, 0.f, 1.f);
  check("prune_width", p.prune_width, 1e-3f, 10.f);
  check("prune_width_peak", p.prune_width_peak, 0.f, 1.f);
  check("prune_power_low", p.prune_power_low, 0.f, 100.f);
  check("prune_power_high", p.prune_power_high, 0.f, 100.f);
  for (std::size_t n = 0; n < p.level.size(); ++n) checkLevel(p.level[n], "level[" + std::to_string(n) + "].");
}

TreeMesh grow(const WeberPenn& parameters, std::uint64_t seed) {
  validate(parameters);
  return Grower(parameters, seed).tree();
}

}  // namespace sunfleck
