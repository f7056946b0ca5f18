#include "grid/stand_index.hpp"

#include <glm/common.hpp>

namespace sunfleck {

StandIndex::StandIndex(std::span<const glm::vec3> positions, float reach, std::optional<glm::vec2> period,
                       glm::ivec2 around)
    : side_(reach) {
  const glm::vec2 sides = period.value_or(glm::vec2(0.f));
  std::vector<Entry> entries;
  Bounds box;
  for (std::uint32_t tree = 0; tree < positions.size(); ++tree) {
    if (std::isnan(positions[tree].x)) continue;
    for (int row = -around.y; row <= around.y; ++row)
      for (int column = -around.x; column <= around.x; ++column) {
        const glm::vec3 shift(static_cast<float>(column) * sides.x, static_cast<float>(row) * sides.y, 0.f);
        entries.push_back({tree, positions[tree], shift});
        box.include(positions[tree] + shift);
      }
  }
  if (entries.empty()) return;

  // Trees far apart must not make more squares than there are trees.
  const glm::vec2 extent = box.size();
  const double most = 4. * static_cast<double>(entries.size()) + 64.;
  const double area = double{extent.x} * double{extent.y}, length = double{extent.x} + double{extent.y};
  side_ = static_cast<float>(std::max({double{side_}, std::sqrt(area / most) * 2., length / most * 4.}));
  low_ = box.low;
  heights_ = {box.low.z, box.high.z};
  size_ = glm::ivec2(glm::floor(extent / side_)) + 1;
  const auto squareOf = [&](const Entry& entry) {
    const glm::ivec2 at(glm::floor((glm::vec2(entry.position + entry.shift) - low_) / side_));
    const glm::ivec2 inside = glm::clamp(at, glm::ivec2(0), size_ - 1);
    return squareNumber(inside.x, inside.y);
  };
  first_.assign(squareNumber(0, size_.y) + 1, 0);
  for (const Entry& entry : entries) ++first_[squareOf(entry) + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  entries_.resize(entries.size());
  for (const Entry& entry : entries) entries_[next[squareOf(entry)]++] = entry;
}

}  // namespace sunfleck
