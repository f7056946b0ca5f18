#include "render/gl/cell_atlas.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <string>

#include "render/gl/too_large.hpp"

namespace sunfleck::gl {
namespace {

bool told(const DrawnTree& tree) {
  return !tree.sky_light.values.empty() ||
         std::ranges::any_of(tree.compensation, [](const auto& of_light) { return !of_light.values.empty(); });
}

bool skyTold(const DrawnStand& stand) {
  return std::ranges::any_of(stand.trees, [](const DrawnTree& tree) { return !tree.sky_light.values.empty(); });
}

// Blocks along x, y and z for so many, as even as may be.
glm::ivec3 blocksFor(std::size_t count, const glm::ivec3& block) {
  const glm::ivec3 most = glm::max(VolumeTexture::longestSide() / block, glm::ivec3(1));
  glm::ivec3 blocks(1);
  const auto room = [&] { return static_cast<std::size_t>(blocks.x) * static_cast<std::size_t>(blocks.y * blocks.z); };
  while (room() < count) {
    glm::ivec3 larger = glm::min(2 * blocks, most);
    int axis = blocks.z <= blocks.y && blocks.z <= blocks.x ? 2 : blocks.y <= blocks.x ? 1 : 0;
    for (int tries = 0; tries < 3 && larger[axis] == blocks[axis]; ++tries) axis = (axis + 1) % 3;
    if (larger[axis] == blocks[axis])
      throw TooLarge("G of " + std::to_string(count) + " trees does not fit into one texture: OpenGL allows " +
                     std::to_string(room()));
    blocks[axis] = larger[axis];
  }
  return blocks;
}

}  // namespace

std::size_t CellAtlas::update(const DrawnStand& stand) {
  std::vector<Held> now(stand.trees.size());
  std::uint32_t count = 0;
  for (std::size_t tree = 0; tree < now.size(); ++tree) {
    const DrawnTree& drawn = stand.trees[tree];
    if (!told(drawn)) continue;
    now[tree].block = count++;
    for (std::size_t light = 0; light < kMostLights; ++light)
      now[tree].compensation[light] = drawn.compensation[light].values.empty() ? 0 : drawn.compensation[light].revision;
    now[tree].sky_light = drawn.sky_light.values.empty() ? 0 : drawn.sky_light.revision;
  }
  glm::ivec3 block_size(1);
  for (const DrawnKind& kind : stand.kinds) block_size = glm::max(block_size, kind.cells.size);
  const bool with_sky = skyTold(stand);
  const int channels = stand.lights.size() > 1 ? 4 : 1;  // fewer are read faster
  const auto room = static_cast<std::uint32_t>(blocks_.x * blocks_.y * blocks_.z);
  if (!compensation_ || channels != compensation_->channels() || block_size != block_size_ || count > room ||
      (with_sky && sky_->size() == glm::ivec3(1))) {
    const glm::ivec3 blocks = blocksFor(std::max<std::size_t>(count, 1), block_size);
    compensation_.reset();  // until all is there
    sky_.emplace(with_sky ? block_size * blocks : glm::ivec3(1), 4);
    compensation_.emplace(block_size * blocks, channels);
    block_size_ = block_size;
    blocks_ = blocks;
    trees_.clear();
  }
  trees_.resize(now.size());
  std::size_t sent = 0;
  for (std::size_t tree = 0; tree < now.size(); ++tree)
    if (now[tree].block != kNoBlock && now[tree] != trees_[tree]) sent += send(stand, tree, now[tree]);
  trees_ = std::move(now);
  return sent;
}

glm::ivec3 CellAtlas::cornerOf(std::uint32_t block) const {
  const int number = static_cast<int>(block);
  return block_size_ * glm::ivec3(number % blocks_.x, number / blocks_.x % blocks_.y, number / (blocks_.x * blocks_.y));
}

std::size_t CellAtlas::send(const DrawnStand& stand, std::size_t tree, const Held& now) {
  const DrawnTree& drawn = stand.trees[tree];
  const glm::ivec3 size = glm::max(stand.kinds[drawn.kind].cells.size, glm::ivec3(1));
  const glm::ivec3 corner = cornerOf(now.block);
  const auto cells = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y * size.z);
  const auto channels = static_cast<std::size_t>(compensation_->channels());
  std::vector<float> values(channels * cells, 1.f);
  for (std::size_t light = 0; light < channels; ++light) {
    const std::span<const float> of_light = drawn.compensation[light].values;
    for (std::size_t cell = 0; cell < std::min(cells, of_light.size()); ++cell)
      values[channels * cell + light] = of_light[cell];
  }
  compensation_->write(corner, size, values);
  std::size_t sent = values.size() * sizeof values[0];
  const std::span<const glm::vec3> sky = drawn.sky_light.values;
  if (sky.empty()) return sent;
  values.assign(4 * cells, 0.f);
  for (std::size_t cell = 0; cell < std::min(cells, sky.size()); ++cell)
    for (std::size_t band = 0; band < 3; ++band) values[4 * cell + band] = sky[cell][static_cast<int>(band)];
  sky_->write(corner, size, values);
  return sent + values.size() * sizeof values[0];
}

void CellAtlas::bind(unsigned compensation, unsigned sky) const {
  compensation_->bind(compensation);
  sky_->bind(sky);
}

}  // namespace sunfleck::gl
