#include "render/shading/leaf_pyramid.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/vec2.hpp>
#include <utility>

#include "render/shading/shading_data.hpp"

namespace sunfleck::shading {
namespace {

using glm::vec2;

// A level while the next one is made of it.
struct Level {
  int width = 0, height = 0;
  std::size_t first = 0;          // of its places
  std::vector<float> shares;      // of the leaf area
  std::vector<vec2> roughnesses;  // of the gloss of both sides, before the nearest table is taken
  std::size_t places() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

class Builder {
 public:
  explicit Builder(const LeafMaps& maps) : maps_(maps), glossy_(maps.glossy()) {}

  LeafPyramid pyramid(std::span<const float> shares) {
    LeafPyramid result{.width = maps_.width, .height = maps_.height, .numbers = {}};
    Level level{.width = maps_.width,
                .height = maps_.height,
                .shares = {shares.begin(), shares.end()},
                .roughnesses = std::vector<vec2>(maps_.places.size())};
    std::size_t all = 0;
    for (int w = maps_.width, h = maps_.height;; w = (w + 1) / 2, h = (h + 1) / 2) {
      all += static_cast<std::size_t>(w) * static_cast<std::size_t>(h);
      if (w == 1 && h == 1) break;
    }
    result.numbers.resize(kLeafPlaceGroups * all);
    overRows(level.height, [&](int row) {
      const std::size_t from = static_cast<std::size_t>(row) * static_cast<std::size_t>(level.width);
      for (std::size_t i = from; i < from + static_cast<std::size_t>(level.width); ++i)
        level.roughnesses[i] = writePlace(maps_.places[i], &result.numbers[kLeafPlaceGroups * i]);
    });
    while (level.places() > 1) level = coarser(level, result.numbers);
    return result;
  }

 private:
  template <typename Work>
  static void overRows(int rows, const Work& work) {
    tbb::parallel_for(tbb::blocked_range<int>(0, rows, 16), [&](const tbb::blocked_range<int>& range) {
      for (int row = range.begin(); row < range.end(); ++row) work(row);
    });
  }

  vec2 writePlace(const LeafPlace& place, vec4* numbers) const {
    vec2 roughnesses(0.f);
    numbers[0] = vec4(place.transmittance, 0.f);
    for (int side = 0; side < 2; ++side) {
      const LeafFace& face = place.faces[static_cast<std::size_t>(side)];
      const float roughness = glossy_ ? maps_.roughnesses[face.roughness] : 0.f;
      numbers[1 + 2 * side] = vec4(face.reflectance, roughness);
      numbers[2 + 2 * side] = vec4(face.gloss, glossy_ ? static_cast<float>(face.roughness) : 0.f);
      roughnesses[side] = roughness;
    }
    return roughnesses;
  }

  Level coarser(const Level& level, std::vector<vec4>& numbers) const {
    Level next{.width = (level.width + 1) / 2, .height = (level.height + 1) / 2, .first = level.first + level.places()};
    next.shares.resize(next.places());
    next.roughnesses.resize(next.places());
    overRows(next.height, [&](int row) {
      for (int column = 0; column < next.width; ++column) {
        std::array<std::size_t, 4> of{};
        std::size_t count = 0;
        float all = 0.f;
        for (int y = 2 * row; y < std::min(2 * row + 2, level.height); ++y)
          for (int x = 2 * column; x < std::min(2 * column + 2, level.width); ++x) {
            of[count++] =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(level.width) + static_cast<std::size_t>(x);
            all += level.shares[of[count - 1]];
          }
        const std::size_t place =
            static_cast<std::size_t>(row) * static_cast<std::size_t>(next.width) + static_cast<std::size_t>(column);
        next.shares[place] = all;
        std::array<vec4, kLeafPlaceGroups> mean{};
        vec2 roughness(0.f), plain(0.f), glosses(0.f);
        for (std::size_t i = 0; i < count; ++i) {
          const float weight = all > 0.f ? level.shares[of[i]] / all : 1.f / static_cast<float>(count);
          const vec4* fine = &numbers[kLeafPlaceGroups * (level.first + of[i])];
          for (std::size_t group = 0; group < kLeafPlaceGroups; ++group) mean[group] += weight * fine[group];
          for (int side = 0; side < 2; ++side) {
            const vec4& of_side = fine[2 + 2 * side];
            const float gloss = weight * (of_side.x + of_side.y + of_side.z), rough = level.roughnesses[of[i]][side];
            glosses[side] += gloss;
            roughness[side] += gloss * rough;
            plain[side] += weight * rough;
          }
        }
        vec4* coarse = &numbers[kLeafPlaceGroups * (next.first + place)];
        for (std::size_t group = 0; group < kLeafPlaceGroups; ++group) coarse[group] = mean[group];
        for (int side = 0; side < 2; ++side) {
          const float rough = glosses[side] > 0.f ? roughness[side] / glosses[side] : plain[side];
          next.roughnesses[place][side] = rough;
          const std::size_t table = glossy_ ? nearestRoughness(maps_.roughnesses, rough) : 0;
          coarse[1 + 2 * side].w = glossy_ ? maps_.roughnesses[table] : 0.f;
          coarse[2 + 2 * side].w = static_cast<float>(table);
        }
      }
    });
    return next;
  }

  const LeafMaps& maps_;
  bool glossy_;
};

}  // namespace

LeafPyramid leafPyramid(const LeafMaps& maps, std::span<const float> shares) {
  return Builder(maps).pyramid(shares);
}

}  // namespace sunfleck::shading
