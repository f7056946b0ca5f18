#include "plants/detail/shared_patches.hpp"

#include <bit>

namespace sunfleck::detail {
namespace {

constexpr std::uint32_t kNone = ~0u;

std::uint64_t hashOf(const LeafPatch& patch) {
  std::uint64_t hash = patch.mask;
  for (const glm::vec2& corner : patch.corners)
    for (const float number : {corner.x, corner.y}) {
      hash = (hash ^ std::bit_cast<std::uint32_t>(number)) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 32;
    }
  return hash;
}

// A mask's corners need not be numbers.
bool same(const LeafPatch& a, const LeafPatch& b) {
  return a.mask == b.mask && a.corners == b.corners;
}

}  // namespace

std::uint32_t SharedPatches::numberOf(const LeafPatch& patch) {
  if (slots_.empty()) slots_.assign(2 * kMostShared, kNone);
  const auto next = static_cast<std::uint32_t>(patches_.size());
  std::size_t slot = hashOf(patch) % slots_.size();
  for (; slots_[slot] != kNone; slot = (slot + 1) % slots_.size())
    if (same(patches_[slots_[slot]], patch)) return slots_[slot];
  if (next < kMostShared) slots_[slot] = next;
  patches_.push_back(patch);
  return next;
}

}  // namespace sunfleck::detail
