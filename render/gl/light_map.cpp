#include "render/gl/light_map.hpp"

namespace sunfleck::gl {

LightMap lightMap(const DeepOpacityMap& map, std::uint64_t revision) {
  return {.axes = map.axes(),
          .origin = map.inMap(glm::vec3(0.f)),
          .corner = map.corner(),
          .pixel_size = map.pixelSize(),
          .size = map.size(),
          .first = map.first(),
          .crossings = map.crossings(),
          .wood_depth = map.woodDepth(),
          .revision = revision};
}

}  // namespace sunfleck::gl
