#include "render/gl/leaf_place_texture.hpp"

#include <algorithm>

#include "render/shading/shading_data.hpp"

namespace sunfleck::gl {

LeafPlaceTexture::LeafPlaceTexture() : places_(BufferTexture::Texel::rgba32f, "the maps of the leaves take") {}

std::size_t LeafPlaceTexture::update(const shading::LeafTables& tables) {
  std::vector<std::shared_ptr<const shading::LeafPyramid>> now;
  for (const shading::LeafTables::OfKind& kind : tables.kinds)
    if (kind.pyramid && std::ranges::find(now, kind.pyramid) == now.end()) now.push_back(kind.pyramid);
  if (now == sent_) return 0;
  const std::size_t texels = shading::kLeafPlaceGroups * std::size_t{tables.places};
  if (texels != places_.capacity()) {
    sent_.clear();
    places_.resize(texels);
  }
  // What lies where it lay stays.
  const std::vector<std::shared_ptr<const shading::LeafPyramid>> before = std::move(sent_);
  sent_.clear();
  std::size_t first = 0, first_before = 0, sent = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const std::vector<glm::vec4>& numbers = now[i]->numbers;
    const bool stays = i < before.size() && before[i] == now[i] && first_before == first;
    if (!stays) {
      places_.write(first, std::span<const glm::vec4>(numbers));
      sent += numbers.size() * sizeof numbers[0];
    }
    first += numbers.size();
    if (i < before.size()) first_before += before[i]->numbers.size();
  }
  sent_ = std::move(now);
  return sent;
}

}  // namespace sunfleck::gl
