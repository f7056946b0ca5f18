#include "render/reference/detail/ray_trees.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

#include "core/instruction_set.hpp"

namespace sunfleck::detail {
namespace {

constexpr std::size_t kWidth = BoxNode::kSize;
constexpr std::size_t kBins = 24;
// Below so many cuts in two by area, halves bound the depth: at most 32 + 24 levels of 15 waiting nodes each for 2^28
// facets, 840 of the 2048 that the walk has room for.
constexpr int kMostCutsByArea = 32;

struct Item {
  Bounds box;
  glm::vec3 middle;
  std::uint32_t number;
};

// A tree of cuts in two, from which the wide one is made.
struct Part {
  Bounds box;
  std::size_t first, last;    // items, one beyond
  int left = -1, right = -1;  // parts
};

float area(const Bounds& box) {
  if (box.empty()) return 0.f;
  const glm::vec3 size = box.size();
  return size.x * size.y + size.y * size.z + size.z * size.x;
}

// Cuts items in two until `most` are left, where the areas of the boxes times the leaves that they take are least.
class Cutting {
 public:
  Cutting(std::vector<Item>& items, std::size_t most) : items_(items), most_(most) { cut(0, items.size(), 0); }
  std::vector<Part> parts;

 private:
  int cut(std::size_t first, std::size_t last, int depth) {
    Part part{.box = {}, .first = first, .last = last};
    for (std::size_t i = first; i < last; ++i) part.box.include(items_[i].box);
    const auto number = static_cast<int>(parts.size());
    parts.push_back(part);
    if (last - first <= most_) return number;
    std::size_t middle = depth < kMostCutsByArea ? byArea(first, last) : first;
    if (middle == first || middle == last) middle = first + (last - first) / 2;
    const int left = cut(first, middle, depth + 1), right = cut(middle, last, depth + 1);
    parts[static_cast<std::size_t>(number)].left = left;
    parts[static_cast<std::size_t>(number)].right = right;
    return number;
  }

  double leaves(std::size_t count) const { return std::ceil(static_cast<double>(count) / static_cast<double>(most_)); }

  // Parts the items at the best of the cuts between bins; `first` where there is none.
  std::size_t byArea(std::size_t first, std::size_t last) {
    Bounds middles;
    for (std::size_t i = first; i < last; ++i) middles.include(items_[i].middle);
    double least = std::numeric_limits<double>::infinity();
    int best_axis = -1;
    std::size_t best_bin = 0;
    const auto binOf = [&](const Item& item, int axis) {
      const float share = (item.middle[axis] - middles.low[axis]) / middles.size()[axis];
      return std::min(kBins - 1, static_cast<std::size_t>(share * float{kBins}));
    };
    for (int axis = 0; axis < 3; ++axis) {
      if (!(middles.size()[axis] > 0.f)) continue;
      std::array<Bounds, kBins> boxes{};
      std::array<std::size_t, kBins> counts{};
      for (std::size_t i = first; i < last; ++i) {
        const std::size_t bin = binOf(items_[i], axis);
        boxes[bin].include(items_[i].box);
        ++counts[bin];
      }
      std::array<double, kBins> above{};  // cost of all bins from this one on
      Bounds box;
      std::size_t count = 0;
      for (std::size_t bin = kBins - 1; bin > 0; --bin) {
        box.include(boxes[bin]);
        count += counts[bin];
        above[bin] = double{area(box)} * leaves(count);
      }
      box = {};
      count = 0;
      for (std::size_t bin = 1; bin < kBins; ++bin) {
        box.include(boxes[bin - 1]);
        count += counts[bin - 1];
        if (count == 0 || count == last - first) continue;
        const double cost = double{area(box)} * leaves(count) + above[bin];
        if (cost < least) {
          least = cost;
          best_axis = axis;
          best_bin = bin;
        }
      }
    }
    if (best_axis < 0) return first;
    const auto middle = std::stable_partition(items_.begin() + static_cast<std::ptrdiff_t>(first),
                                              items_.begin() + static_cast<std::ptrdiff_t>(last),
                                              [&](const Item& item) { return binOf(item, best_axis) < best_bin; });
    return static_cast<std::size_t>(middle - items_.begin());
  }

  std::vector<Item>& items_;
  std::size_t most_;
};

// Makes nodes of sixteen boxes; `leafOf(first, last)` numbers the leaf of those items.
template <typename LeafOf>
std::int32_t widen(const std::vector<Part>& parts, int from, std::vector<BoxNode>& nodes, const LeafOf& leafOf) {
  const auto part = [&](int number) -> const Part& { return parts[static_cast<std::size_t>(number)]; };
  std::vector<int> open{from};
  while (open.size() < kWidth) {
    int largest = -1;
    for (std::size_t i = 0; i < open.size(); ++i)
      if (part(open[i]).left >= 0 &&
          (largest < 0 || area(part(open[i]).box) > area(part(open[static_cast<std::size_t>(largest)]).box)))
        largest = static_cast<int>(i);
    if (largest < 0) break;
    const Part& cut = part(open[static_cast<std::size_t>(largest)]);
    open[static_cast<std::size_t>(largest)] = cut.left;
    open.push_back(cut.right);
  }
  const std::size_t number = nodes.size();
  nodes.emplace_back();
  BoxNode node{};
  for (std::size_t i = 0; i < kWidth; ++i) {
    const Bounds box = i < open.size() ? part(open[i]).box : Bounds{};
    for (int axis = 0; axis < 3; ++axis) {
      node.low[axis][i] = box.low[axis];
      node.high[axis][i] = box.high[axis];
    }
    if (i >= open.size()) continue;
    const Part& of = part(open[i]);
    node.child[i] = of.left < 0 ? ~leafOf(of.first, of.last) : widen(parts, open[i], nodes, leafOf);
  }
  for (unsigned octant = 0; octant < 8; ++octant) {
    std::array<float, kWidth> along{};  // twice the middle's place along the diagonal of the octant
    for (std::size_t i = 0; i < open.size(); ++i)
      for (unsigned axis = 0; axis < 3; ++axis)
        along[i] += (octant >> axis & 1 ? -1.f : 1.f) * (node.low[axis][i] + node.high[axis][i]);
    std::array<std::uint8_t, kWidth> order;
    std::iota(order.begin(), order.end(), std::uint8_t{0});
    std::stable_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(open.size()),
                     [&](std::uint8_t a, std::uint8_t b) { return along[a] > along[b]; });
    std::ranges::copy(order, node.order[octant]);
  }
  nodes[number] = node;
  return static_cast<std::int32_t>(number);
}

// As the walk rounds, a facet may be met a little outside of its box.
Bounds withMargin(Bounds box) {
  const glm::vec3 margin =
      4.f * std::numeric_limits<float>::epsilon() * glm::max(glm::abs(box.low), glm::abs(box.high));
  return {.low = box.low - margin, .high = box.high + margin};
}

Bounds boxOf(const Facet& facet) {
  Bounds box;
  for (const glm::dvec3& corner : {facet.corner, facet.corner + facet.first, facet.corner + facet.second,
                                   facet.corner + (facet.parallelogram ? facet.first + facet.second : facet.first)})
    box.include(glm::vec3(corner));
  return withMargin(box);
}

void set(FacetLeaf& leaf, std::size_t lane, const Facet& facet) {
  const glm::dvec3 across = glm::cross(facet.first, facet.second);
  const double area = glm::length(across);
  const glm::dvec3 normal = across / area;
  const glm::dvec3 u = glm::cross(facet.second, normal) / area, v = glm::cross(normal, facet.first) / area;
  const auto put = [&](float(*lanes)[FacetLeaf::kSize], const glm::dvec3& gradient, double constant) {
    for (int axis = 0; axis < 3; ++axis) lanes[axis][lane] = static_cast<float>(gradient[axis]);
    lanes[3][lane] = static_cast<float>(constant);
  };
  put(leaf.plane, normal, glm::dot(normal, facet.corner));
  put(leaf.u, u, -glm::dot(u, facet.corner));
  put(leaf.v, v, -glm::dot(v, facet.corner));
  leaf.facet[lane] =
      facet.primitive | (facet.parallelogram ? FacetLeaf::kParallelogram : 0u) | (facet.wood ? FacetLeaf::kWood : 0u);
}

// Where the boxes below a tree's first node are after the copy's rotation and move.
Bounds boxOf(const BoxNode& root, const Copy& copy) {
  Bounds box;
  for (std::size_t i = 0; i < kWidth; ++i) {
    if (root.low[0][i] > root.high[0][i]) continue;
    for (int corner = 0; corner < 8; ++corner)
      box.include(copy.rotated({(corner & 1 ? root.low : root.high)[0][i], (corner & 2 ? root.low : root.high)[1][i],
                                (corner & 4 ? root.low : root.high)[2][i]}) +
                  copy.translation);
  }
  return withMargin(box);
}

}  // namespace

bool RayTrees::suitMachine() {
#ifdef SUNFLECK_X86
  return instructionSet() == InstructionSet::avx512;
#else
  return false;
#endif
}

RayTrees::RayTrees(const std::vector<std::vector<Facet>>& kinds, const std::vector<Copy>& copies) {
#ifdef SUNFLECK_X86
  closest_ = &avx512::closestFacet;
  any_ = &avx512::anyFacet;
#endif
  for (const std::vector<Facet>& facets : kinds) {
    FacetTree& tree = trees_.emplace_back();
    std::vector<Item> items;
    for (std::size_t i = 0; i < facets.size(); ++i) {
      const Bounds box = boxOf(facets[i]);
      if (glm::length(glm::cross(facets[i].first, facets[i].second)) > 0.)
        items.push_back({box, box.centre(), static_cast<std::uint32_t>(i)});
    }
    if (items.empty()) continue;
    const Cutting cutting(items, FacetLeaf::kSize);
    widen(cutting.parts, 0, tree.nodes, [&](std::size_t first, std::size_t last) {
      FacetLeaf& leaf = tree.leaves.emplace_back();  // a lane of no facet has a plane that no ray meets: 0 / 0
      for (std::size_t i = first; i < last; ++i) set(leaf, i - first, facets[items[i].number]);
      return static_cast<std::int32_t>(tree.leaves.size() - 1);
    });
  }
  for (const FacetTree& tree : trees_) views_.push_back({tree.nodes.data(), tree.leaves.data()});
  std::vector<Item> items;
  for (std::size_t i = 0; i < copies.size(); ++i) {
    const Copy& copy = copies[i];
    const glm::vec3& t = copy.translation;
    copies_.push_back({copy.cosine, copy.sine, {t.x, t.y, t.z}, copy.kind});
    if (trees_[copy.kind].nodes.empty()) continue;
    const Bounds box = boxOf(trees_[copy.kind].nodes.front(), copy);
    items.push_back({box, box.centre(), static_cast<std::uint32_t>(i)});
  }
  empty_ = items.empty();
  if (empty_ || standsAsItIs(copies)) return;
  const Cutting cutting(items, 1);
  widen(cutting.parts, 0, top_,
        [&](std::size_t first, std::size_t) { return static_cast<std::int32_t>(items[first].number); });
}

}  // namespace sunfleck::detail
