#include "render/gl/field_texture.hpp"

#include <algorithm>
#include <glm/vec4.hpp>

namespace sunfleck::gl {

FieldTexture::FieldTexture()
    : places_(BufferTexture::Texel::r32ui, "the places of the light field take"),
      light_(BufferTexture::Texel::rgba32f, "the light field takes") {}

std::size_t FieldTexture::update(const DrawnStand& stand, const std::vector<const TreeLevels*>& levels) {
  std::vector<Held> now(stand.trees.size());
  std::size_t texels = 0;
  for (std::size_t tree = 0; tree < now.size(); ++tree) {
    const TreeValues<glm::vec3>& field = stand.trees[tree].field;
    if (field.values.empty()) continue;
    now[tree] = {static_cast<std::uint32_t>(texels), field.revision};
    texels += field.values.size();
  }
  Held ground;
  if (!stand.ground_field.values.empty()) {
    ground = {static_cast<std::uint32_t>(texels), stand.ground_field.revision};
    texels += stand.ground_field.values.size();
  }
  std::size_t sent = texels > 0 ? sendPlaces(stand, levels) : 0;
  if (texels > light_.capacity()) {
    light_.resize(texels);
    trees_.clear();
    ground_ = {};
  }
  trees_.resize(now.size());
  std::vector<glm::vec4> texel_values;
  const auto send = [&](const TreeValues<glm::vec3>& values, std::uint32_t first) {
    texel_values.clear();
    for (const glm::vec3& value : values.values) texel_values.emplace_back(value, 0.f);
    light_.write(first, std::span<const glm::vec4>(texel_values));
    sent += texel_values.size() * sizeof texel_values[0];
  };
  for (std::size_t tree = 0; tree < now.size(); ++tree) {
    if (now[tree].first == ~0u || now[tree] == trees_[tree]) continue;
    send(stand.trees[tree].field, now[tree].first);
  }
  trees_ = std::move(now);
  if (ground.first != ~0u && ground != ground_) send(stand.ground_field, ground.first);
  ground_ = ground;
  return sent;
}

std::size_t FieldTexture::sendPlaces(const DrawnStand& stand, const std::vector<const TreeLevels*>& levels) {
  // Those of all kinds in trees that are far follow those in the others.
  std::vector<std::uint32_t> all;
  const bool any_far = std::ranges::any_of(stand.trees, &DrawnTree::far);
  for (const bool far : {false, true}) {
    if (far && !any_far) continue;
    for (std::size_t kind = 0; kind < levels.size(); ++kind) {
      const DrawnKind& of_kind = stand.kinds[kind];
      const std::span<const std::uint32_t> places = far ? of_kind.far_field_places : of_kind.field_places;
      for (const std::uint32_t source : levels[kind]->sources)
        all.push_back(source < places.size() ? places[source] : 0u);
    }
  }
  if (all == held_places_) return 0;
  places_.assign(std::span<const std::uint32_t>(all));
  held_places_ = std::move(all);
  return held_places_.size() * sizeof held_places_[0];
}

void FieldTexture::bind(unsigned places, unsigned light) const {
  places_.bind(places);
  light_.bind(light);
}

}  // namespace sunfleck::gl
