#include "render/reference/trace_medium.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>

#include "core/require.hpp"

namespace sunfleck {
namespace {

constexpr float kMostDensity = 1e9f;  // [1/m]
constexpr float kFarthest = 1e7f;     // [m]

bool isDensity(float value) {
  return value >= 0.f && value <= kMostDensity;
}

void validateVoxels(const MediumVoxels& voxels) {
  require(voxels.cell_size > 0.f && voxels.cell_size <= kFarthest, "cell size of a medium", voxels.cell_size,
          "above 0 and at most 1e7 m");
  for (int axis = 0; axis < 3; ++axis)
    require(std::abs(voxels.corner[axis]) <= kFarthest, "corner of a medium's cells", voxels.corner[axis],
            "finite and at most 1e7 m in size");
  require(!voxels.blocks.empty(), "number of blocks of a medium's cells", 0, "at least 1");
  require(voxels.blocks.size() < 1u << 23, "number of blocks of a medium's cells", voxels.blocks.size(), "below 2^23");
  const std::size_t cells = voxels.blocks.size() * MediumVoxels::kCells;
  require(voxels.density.size() == cells, "number of a medium's densities", voxels.density.size(),
          "that of the cells, " + std::to_string(cells));
  require(voxels.leaves.empty() || voxels.leaves.size() == cells, "number of a medium's projected areas",
          voxels.leaves.size(), "that of the cells, or 0");
  for (const float value : voxels.density) require(isDensity(value), "density of a medium", value, "in [0, 1e9] 1/m");
  for (const ProjectedArea& area : voxels.leaves)
    for (const float value : {area.xx, area.yy, area.zz, area.xy, area.xz, area.yz})
      require(std::abs(value) <= 1.01f, "squared projected area of a medium's leaves", value, "in [-1, 1]");
}

// FNV-1a by G. Fowler, L. C. Noll and K.-P. Vo, by words of 32 bits, in two halves of other beginnings.
class Hash {
 public:
  template <typename Value>
  void add(std::span<const Value> values) {
    static_assert(sizeof(Value) % sizeof(std::uint32_t) == 0);
    const char* bytes = reinterpret_cast<const char*>(values.data());
    for (std::size_t i = 0; i < values.size_bytes(); i += sizeof(std::uint32_t)) {
      std::uint32_t word;
      std::memcpy(&word, bytes + i, sizeof word);
      low_ = (low_ ^ word) * 0x100000001b3u;
      high_ = (high_ ^ word ^ low_ >> 32) * 0x100000001b3u;
    }
  }
  template <typename Value>
  void add(const Value& value) {
    add(std::span(&value, 1));
  }
  std::string text() const { return fmt::format("{:016x}{:016x}", high_, low_); }

 private:
  std::uint64_t low_ = 0xcbf29ce484222325u, high_ = 0x6c62272e07bb0142u;
};

}  // namespace

Bounds occupied(const TraceMedium& medium) {
  if (!medium.voxels) return medium.box;
  const MediumVoxels& voxels = *medium.voxels;
  glm::ivec3 low(INT32_MAX), high(INT32_MIN);
  for (std::size_t block = 0; block < voxels.blocks.size(); ++block) {
    const float* density = voxels.density.data() + block * MediumVoxels::kCells;
    const glm::ivec3 first = MediumVoxels::kSide * voxels.blocks[block];
    for (int i = 0; i < static_cast<int>(MediumVoxels::kCells); ++i) {
      if (density[i] == 0.f) continue;
      const glm::ivec3 cell = first + glm::ivec3(i / 64, i / 8 % 8, i % 8);
      low = glm::min(low, cell);
      high = glm::max(high, cell + 1);
    }
  }
  Bounds box;
  if (low.x > high.x) return box;
  box.low = voxels.corner + voxels.cell_size * glm::vec3(low);
  box.high = voxels.corner + voxels.cell_size * glm::vec3(high);
  if (!medium.box.empty()) {
    box.low = glm::max(box.low, medium.box.low);
    box.high = glm::min(box.high, medium.box.high);
  }
  return box;
}

void validate(const TraceMedium& medium, const std::optional<glm::vec2>& period) {
  require(std::abs(medium.asymmetry) < 1.f, "asymmetry of a medium", medium.asymmetry, "in (-1, 1)");
  double weight = 0.;
  for (const LeafRing& ring : medium.rings) {
    require(ring.cosine >= 0.f && ring.cosine <= 1.f, "cosine of leaves' inclination", ring.cosine, "in [0, 1]");
    require(ring.weight >= 0.f && ring.weight <= 1.f, "weight of leaves of an inclination", ring.weight, "in [0, 1]");
    weight += double{ring.weight};
  }
  require(medium.rings.empty() || std::abs(weight - 1.) < 1e-4, "sum of the weights of leaves' inclinations", weight,
          "1");
  require(isDensity(medium.density), "density of a medium", medium.density, "in [0, 1e9] 1/m");
  if (medium.voxels) validateVoxels(*medium.voxels);
  const Bounds box = occupied(medium);
  for (int axis = 0; axis < 3; ++axis) {
    const bool endless = period && axis < 2 && !medium.voxels;
    if (endless && box.low[axis] == -INFINITY && box.high[axis] == INFINITY) continue;
    for (const float side : {box.low[axis], box.high[axis]})
      require(std::abs(side) <= kFarthest, "side of a medium's box", side,
              period ? "finite, at most 1e7 m in size" : "finite, at most 1e7 m in size: the stand has no period");
    require(box.low[axis] < box.high[axis], "upper side of a medium's box", box.high[axis], "above the lower one");
    if (!period || axis == 2) continue;
    const float room = (*period)[axis] * (1.f + 1e-5f) + (medium.voxels ? medium.voxels->cell_size : 0.f);
    require(box.high[axis] - box.low[axis] < room, "width of a medium", box.high[axis] - box.low[axis],
            "at most the stand's period, " + std::to_string((*period)[axis]) + " m");
  }
}

std::string mediaHash(const std::vector<TraceMedium>& media) {
  if (media.empty()) return "";
  Hash hash;
  for (const TraceMedium& medium : media) {
    hash.add(static_cast<std::uint32_t>(medium.scatterer));
    hash.add(medium.asymmetry);
    hash.add(std::span(medium.rings));
    hash.add(static_cast<std::uint64_t>(medium.rings.size()));
    hash.add(medium.box);
    hash.add(medium.density);
    hash.add(static_cast<std::uint32_t>(medium.voxels.has_value()));
    if (!medium.voxels) continue;
    hash.add(medium.voxels->corner);
    hash.add(medium.voxels->cell_size);
    hash.add(static_cast<std::uint64_t>(medium.voxels->blocks.size()));
    hash.add(std::span(medium.voxels->blocks));
    hash.add(std::span(medium.voxels->density));
    hash.add(std::span(medium.voxels->leaves));
  }
  return hash.text();
}

}  // namespace sunfleck
