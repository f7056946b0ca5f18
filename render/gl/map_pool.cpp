#include "render/gl/map_pool.hpp"

#include <utility>

#include "render/gl/detail/frame_data.hpp"

namespace sunfleck::gl {
namespace {

// Room for the crossings of a map along another light, which sees the same leaves from another side.
std::size_t withRoom(std::size_t crossings) {
  return crossings + crossings / 4;
}

}  // namespace

MapPool::MapPool()
    : lines_(BufferTexture::Texel::rgb32ui, "the light's opacity map takes", TooLarge::What::light_map),
      crossings_(BufferTexture::Texel::rg32ui, "the light's opacity map takes", TooLarge::What::light_map),
      frames_(Buffer::writable(kMostLights * kMostKinds * sizeof(detail::MapFrame))) {}

bool MapPool::fits(const DrawnStand& stand) const {
  if (held_.size() != kMostLights * stand.kinds.size()) return false;
  for (std::size_t kind = 0; kind < stand.kinds.size(); ++kind)
    for (std::size_t light = 0; light < stand.kinds[kind].maps.size(); ++light) {
      const LightMap& map = stand.kinds[kind].maps[light];
      const Held& held = held_[kMostLights * kind + light];
      if (map.wood_depth.size() > held.lines || map.crossings.size() > held.crossings) return false;
    }
  return true;
}

void MapPool::makeRoom(const DrawnStand& stand) {
  held_.clear();  // until there is room
  std::vector<Held> held(kMostLights * stand.kinds.size());
  std::size_t lines = 0, crossings = 0;
  for (std::size_t kind = 0; kind < stand.kinds.size(); ++kind)
    for (std::size_t light = 0; light < stand.kinds[kind].maps.size(); ++light) {
      const LightMap& map = stand.kinds[kind].maps[light];
      Held& room = held[kMostLights * kind + light];
      room = {.first_line = lines,
              .lines = withRoom(map.wood_depth.size()),
              .first_crossing = crossings,
              .crossings = withRoom(map.crossings.size())};
      lines += room.lines;
      crossings += room.crossings;
    }
  lines_.resize(lines);
  crossings_.resize(crossings);
  held_ = std::move(held);
}

std::size_t MapPool::send(const LightMap& map, Held& held) {
  held.revision = map.revision;
  if (map.made) {
    lines_.copy(held.first_line, map.made->lines);
    crossings_.copy(held.first_crossing, map.made->crossings);
    return 0;
  }
  std::vector<detail::MapLine> lines;
  lines.reserve(map.wood_depth.size());
  for (std::size_t i = 0; i < map.wood_depth.size(); ++i)
    lines.push_back({.first = map.first[i], .end = map.first[i + 1], .wood_depth = map.wood_depth[i]});
  lines_.write(held.first_line, std::span<const detail::MapLine>(lines));
  crossings_.write(held.first_crossing, map.crossings);
  return lines.size() * sizeof lines[0] + map.crossings.size_bytes();
}

std::size_t MapPool::update(const DrawnStand& stand) {
  if (!fits(stand)) makeRoom(stand);
  std::size_t sent = 0;
  std::vector<detail::MapFrame> frames(held_.size());
  for (std::size_t kind = 0; kind < stand.kinds.size(); ++kind)
    for (std::size_t light = 0; light < stand.kinds[kind].maps.size(); ++light) {
      const LightMap& map = stand.kinds[kind].maps[light];
      Held& held = held_[kMostLights * kind + light];
      if (map.revision != held.revision) sent += send(map, held);
      frames[kMostLights * kind + light] = {
          .origin = glm::vec4(map.origin, map.pixel_size),
          .corner = glm::vec4(map.corner, 0.f, 0.f),
          .size = {static_cast<std::uint32_t>(map.size.x), static_cast<std::uint32_t>(map.size.y),
                   static_cast<std::uint32_t>(held.first_line), static_cast<std::uint32_t>(held.first_crossing)}};
    }
  frames_.write(0, std::as_bytes(std::span(frames)));
  return sent;
}

void MapPool::bind(unsigned lines, unsigned crossings, unsigned frames) const {
  lines_.bind(lines);
  crossings_.bind(crossings);
  frames_.bindUniform(frames);
}

}  // namespace sunfleck::gl
