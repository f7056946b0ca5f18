#include "plants/weber_penn.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/require.hpp"
#include "plants/detail/budding.hpp"
#include "plants/detail/leaf_placement.hpp"
#include "plants/detail/portable_math.hpp"
#include "plants/detail/pruning.hpp"
#include "plants/detail/stem.hpp"
#include "plants/detail/tube.hpp"
#include "plants/detail/weber_penn_fields.hpp"

namespace sunfleck {
namespace {

using namespace detail;

constexpr std::size_t kMostVertices = 100'000'000;
constexpr std::uint64_t kMostStems = 20'000'000;

// How a stem hangs on its parent.
struct Parentage {
  double parent_length;  // [m]
  double offset_share;   // where on the parent, over its length [1]
  double full_length;    // the stem's length over its parent's before the crown's shape shortens it [1]
};

// A stem that waits for its wood and its leaves.
struct Waiting {
  Bud bud;
  Random random;                 // of the stem: from after its growth, or from before it
  double leaves = 0.;            // that it would bear along its whole length
  bool grown = false;            // else it grows together with others
  std::vector<Strand> strands;   // none are left of one that does not fit
  std::vector<int> leaf_counts;  // of each strand, of stems that bear leaves
};

// How much a mesh holds.
struct TreeSize {
  std::size_t vertices, leaf_triangles, wood_triangles;
  std::uint32_t leaves;

  TreeSize operator+(const TreeSize& other) const {
    return {vertices + other.vertices, leaf_triangles + other.leaf_triangles, wood_triangles + other.wood_triangles,
            leaves + other.leaves};
  }
};

TreeSize sizeOf(const TreeMesh& mesh) {
  return {mesh.vertices.size(), mesh.leaf_triangles.size(), mesh.wood_triangles.size(), mesh.leaf_count};
}

// Grows a tree in the order of its stems, each before its children. Only what hangs on that order is done one after the
// other: where stems stand, and how roundings carry over from stem to stem. Wood and leaves, and the last level's
// stems unless their splits carry over, are made in parallel, some thousand stems at a time, and put together in order.
class Grower {
 public:
  Grower(const WeberPenn& parameters, std::uint64_t seed)
      : parameters_(parameters), templates_(parameters), seed_(seed) {
    mesh_.patches = templates_.patches();
  }

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
    buildWaiting();
    checkReach();
    return std::move(mesh_);
  }

 private:
  Random nextStream() {
    require(next_stream_ < kMostStems, "WeberPenn: stems of the tree", next_stream_ + 1, "at most 20000000");
    return Random(seed_, next_stream_++);
  }

  const WeberPenn::Level& levelOf(const Bud& bud) const {
    return parameters_.level[static_cast<std::size_t>(bud.level)];
  }

  void stem(const Bud& bud, const Parentage& parentage) {
    Waiting stem{.bud = bud, .random = nextStream()};
    const bool last = bud.level + 1 == parameters_.levels;
    if (last) stem.leaves = leavesOn(parentage);
    // The trunk has splits of its own, others those that the stems before them left over.
    if (!last || bud.level == 0 || levelOf(bud).seg_splits > 0.f) {
      stem.strands = prunedStrands(stem.bud, split_debt_, stem.random);
      stem.grown = true;
    }
    if (last) return wait(std::move(stem));
    const Bud parent = stem.bud;
    Random random = stem.random;
    const std::vector<Strand> strands = stem.strands;
    wait(std::move(stem));
    for (const Strand& strand : strands) branch(parent, strand, stemsOn(parent, parentage), random);
  }

  void wait(Waiting stem) {
    constexpr std::size_t kMostWaiting = 1 << 15, kMostStations = 1 << 20;  // some 100 MB
    stations_ += static_cast<std::size_t>(levelOf(stem.bud).curve_res) + 1;
    for (const Strand& strand : stem.strands) stations_ += strand.size();
    waiting_.push_back(std::move(stem));
    if (waiting_.size() >= kMostWaiting || stations_ >= kMostStations) buildWaiting();
  }

  void buildWaiting() {
    tbb::parallel_for(std::size_t{0}, waiting_.size(), [&](std::size_t i) {
      Waiting& stem = waiting_[i];
      SplitDebt none{};
      if (!stem.grown) stem.strands = prunedStrands(stem.bud, none, stem.random);
    });
    for (Waiting& stem : waiting_)
      if (stem.bud.level + 1 == parameters_.levels)
        for (const Strand& strand : stem.strands)
          stem.leaf_counts.push_back(parameters_.leaves < 0 ? -parameters_.leaves
                                                            : wholeLeaves(stem.leaves * shareOf(stem.bud, strand)));
    constexpr std::size_t kTogether = 64;  // stems in one piece of the mesh
    std::vector<TreeMesh> pieces((waiting_.size() + kTogether - 1) / kTogether);
    tbb::parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t piece) {
      const std::size_t end = std::min(waiting_.size(), (piece + 1) * kTogether);
      for (std::size_t i = piece * kTogether; i < end; ++i) build(waiting_[i], pieces[piece]);
      dropFlatWood(pieces[piece]);
    });
    append(pieces);
    waiting_.clear();
    stations_ = 0;
  }

  void build(Waiting& stem, TreeMesh& mesh) const {
    for (const Strand& strand : stem.strands) addTube(parameters_, stem.bud, strand, mesh);
    for (std::size_t i = 0; i < stem.leaf_counts.size(); ++i)
      placeLeaves(parameters_, templates_, stem.bud, stem.strands[i], stem.leaf_counts[i], stem.random, mesh);
  }

  static void dropFlatWood(TreeMesh& mesh) {
    std::erase_if(mesh.wood_triangles, [&](const glm::uvec3& t) { return !(triangleArea(mesh, t) > 0.); });
  }

  void append(const std::vector<TreeMesh>& pieces) {
    std::vector<TreeSize> starts{sizeOf(mesh_)};
    for (const TreeMesh& piece : pieces) starts.push_back(starts.back() + sizeOf(piece));
    const TreeSize& all = starts.back();
    require(all.vertices <= kMostVertices, "WeberPenn: vertices of the tree", all.vertices, "at most 100000000");
    mesh_.vertices.resize(all.vertices);
    mesh_.leaf_triangles.resize(all.leaf_triangles);
    mesh_.leaf_of_triangle.resize(all.leaf_triangles);
    mesh_.patch_of_triangle.resize(all.leaf_triangles);
    mesh_.wood_triangles.resize(all.wood_triangles);
    mesh_.leaf_count = all.leaves;
    tbb::parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t i) {
      const TreeMesh& piece = pieces[i];
      const TreeSize& start = starts[i];
      const auto put = [](const auto& from, auto& to, std::size_t at, auto shift) {
        for (std::size_t k = 0; k < from.size(); ++k) to[at + k] = from[k] + shift;
      };
      const auto vertex = static_cast<std::uint32_t>(start.vertices);
      const auto copy = [](const auto& from, auto& to, std::size_t at) {
        std::copy(from.begin(), from.end(), to.begin() + static_cast<std::ptrdiff_t>(at));
      };
      copy(piece.vertices, mesh_.vertices, start.vertices);
      copy(piece.patch_of_triangle, mesh_.patch_of_triangle, start.leaf_triangles);
      put(piece.leaf_triangles, mesh_.leaf_triangles, start.leaf_triangles, vertex);
      put(piece.wood_triangles, mesh_.wood_triangles, start.wood_triangles, vertex);
      put(piece.leaf_of_triangle, mesh_.leaf_of_triangle, start.leaf_triangles, start.leaves);
    });
  }

  // Leaves and triangles are told apart and of an area already, which finish() would do over again.
  void checkReach() {
    constexpr float kFar = 1e4f;  // [m]
    const bool near = std::all_of(mesh_.vertices.begin(), mesh_.vertices.end(), [](const glm::vec3& v) {
      return std::abs(v.x) <= kFar && std::abs(v.y) <= kFar && std::abs(v.z) <= kFar;
    });
    if (!near || mesh_.leaf_count == 0) finish(mesh_, "tree");  // refuses it in its own words
  }

  // Grows the stem and shortens it until it stays above the ground, and then, by prune_ratio, inside the pruning
  // envelope; empty when nothing is left of it. The ground is ours: drooping branches of the paper would grow into it.
  std::vector<Strand> prunedStrands(Bud& bud, SplitDebt& debt, Random& random) const {
    const Random before = random;
    const SplitDebt debt_before = debt;
    std::vector<Strand> strands = growStem(parameters_, bud, debt, random);
    if (bud.level == 0) return strands;
    const auto regrow = [&](double length) {
      bud.length = length;
      random = before;
      debt = debt_before;
      strands = growStem(parameters_, bud, debt, random);
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
    return std::abs(parameters_.leaves) * shapeRatio(WeberPenn::Shape::tapered_cylindrical, parentage.offset_share);
  }

  int wholeLeaves(double wanted) {
    const int whole = std::max(0, static_cast<int>(std::lround(wanted + leaf_debt_)));
    leaf_debt_ += wanted - whole;
    return whole;
  }

  // Number of children a stem would bear along its whole length.
  double stemsOn(const Bud& bud, const Parentage& parentage) const {
    const double most = std::abs(parameters_.level[static_cast<std::size_t>(bud.level) + 1].branches);
    if (bud.level == 0) return most;
    if (bud.level == 1)
      return most * std::min(1., 0.2 + 0.8 * (bud.length / parentage.parent_length) / parentage.full_length);
    return most * (1. - 0.5 * parentage.offset_share);
  }

  void branch(const Bud& parent, const Strand& strand, double stems, Random& random) {
    const WeberPenn::Level& level = parameters_.level[static_cast<std::size_t>(parent.level) + 1];
    const double bare = double{parameters_.level[static_cast<std::size_t>(parent.level)].base_size} * parent.length;
    if (stems < 0.01) return;
    if (level.branches < 0) return fan(parent, strand, level, random);
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
      child.radius =
          std::min(parent.radius * portable::power(child.length / parent.length, double{parameters_.ratio_power}),
                   radiusAt(parameters_, parent, offset / parent.length));
      if (child.length > 1e-3 * height_)
        stem(child, {.parent_length = parent.length, .offset_share = offset / parent.length, .full_length = full});
    }
  }

  void fan(const Bud& parent, const Strand& strand, const WeberPenn::Level& level, Random& random) {
    const int count = -level.branches;
    for (int i = 0; i < count; ++i) {
      const double full = std::max(0.02, double{level.length} + vary(random, double{level.length_v}));
      Bud child{.base = frameAt(strand, parent.length), .level = parent.level + 1, .length = full * parent.length};
      fanOut(child.base, level, (i + 0.5) / count, random);
      child.radius = parent.radius * portable::power(full, double{parameters_.ratio_power});
      if (child.length > 1e-3 * height_)
        stem(child, {.parent_length = parent.length, .offset_share = 1., .full_length = full});
    }
  }

  double crownShape(double towards_base) const {
    return parameters_.shape == WeberPenn::Shape::envelope ? envelopeWidth(parameters_, towards_base)
                                                           : shapeRatio(parameters_.shape, towards_base);
  }

  const WeberPenn& parameters_;
  LeafTemplates templates_;
  std::uint64_t seed_;
  std::uint64_t next_stream_ = 0;  // a stream of random numbers for every stem
  double height_ = 0.;             // of this tree: scale +- scale_v [m]
  SplitDebt split_debt_{};
  double leaf_debt_ = 0.;  // leaves that rounding owes to the next twig
  std::vector<Waiting> waiting_;
  std::size_t stations_ = 0;  // of those, about
  TreeMesh mesh_;
};

template <typename Value>
void check(const std::string& field, Value value, float least, float most) {
  if constexpr (std::is_enum_v<Value>) {
    return;  // of which there are no wrong ones
  } else {
    std::ostringstream rule;
    rule << "in [" << least << ", " << most << "]";
    const auto number = static_cast<float>(value);
    require(number >= least && number <= most, "WeberPenn." + field, value, rule.str());
  }
}

}  // namespace

void validate(const WeberPenn& p) {
  eachField(p, [](const std::string& table, const std::string& key, const auto& value, float least, float most) {
    const bool of_level = table.starts_with("level");
    check(of_level ? "level[" + table.substr(5) + "]." + key : key, value, least, most);
  });
}

TreeMesh grow(const WeberPenn& parameters, std::uint64_t seed) {
  validate(parameters);
  return Grower(parameters, seed).tree();
}

}  // namespace sunfleck
