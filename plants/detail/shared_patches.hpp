#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/leaf_patch.hpp"

namespace sunfleck::detail {

// Gathers the patches of a mesh as a file brings them: most leaves of a tree show the same few parts of their images,
// which are kept once.
class SharedPatches {
 public:
  explicit SharedPatches(std::vector<LeafPatch>& patches) : patches_(patches) {}

  // The number of such a patch, which is added where there is none yet.
  std::uint32_t numberOf(const LeafPatch& patch);

 private:
  // Beyond so many, which are all different then, others are added without being looked for.
  static constexpr std::size_t kMostShared = 1 << 16;

  std::vector<LeafPatch>& patches_;
  std::vector<std::uint32_t> slots_;  // a hash table of numbers with open addresses
};

}  // namespace sunfleck::detail
