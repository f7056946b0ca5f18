#include "field/stand_sun.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>

#include "core/bounds.hpp"
#include "core/shared_progress.hpp"
#include "grid/detail/scan_conversion.hpp"

namespace sunfleck {
namespace {

constexpr int kTile = 512;  // pixels along a tile: its depths stay in a core's cache
constexpr float kNothing = std::numeric_limits<float>::infinity();

// A tree as it stands in the picture, or one of its copies in a stand that repeats.
struct Copy {
  std::size_t tree;
  glm::ivec2 low;  // first pixel
};

glm::ivec2 floorDiv(const glm::ivec2& a, const glm::ivec2& b) {
  return glm::ivec2(glm::floor(glm::dvec2(a) / glm::dvec2(b)));
}

}  // namespace

SunLines sunLines(Direction along, double area, const std::optional<glm::vec2>& period) {
  SunLines lines{.along = along};
  const glm::dvec3 s(along);
  if (period) {
    const glm::dvec2 sides(*period);
    const double wanted = std::sqrt(area / std::abs(s.z));  // side of a pixel on the ground [m]
    const glm::dvec2 count = glm::max(glm::round(sides / wanted), 1.);
    lines.repeat = glm::ivec2(count);
    const glm::dvec2 scale = count / sides;
    lines.right = scale.x * glm::dvec3(1., 0., -s.x / s.z);
    lines.up = scale.y * glm::dvec3(0., 1., -s.y / s.z);
    lines.depth = {0., 0., 1. / s.z};
    lines.line_area = std::abs(s.z) / (scale.x * scale.y);
    lines.mirrored = true;  // as the light goes down
  } else {
    const Axes axes = axesAlong(along);
    const double scale = 1. / std::sqrt(area);
    lines.right = scale * glm::dvec3(axes.right);
    lines.up = scale * glm::dvec3(axes.up);
    lines.depth = s;
    lines.line_area = area;
  }
  return lines;
}

TreePicture treePicture(const TreeMesh& mesh, const FieldElements& elements, float rotation, const SunLines& lines) {
  const double cosine = std::cos(double{rotation}), sine = std::sin(double{rotation});
  std::vector<glm::vec3> corners(mesh.vertices.size());
  Bounds box;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 v(mesh.vertices[i]);
    const glm::dvec3 turned(cosine * v.x - sine * v.y, sine * v.x + cosine * v.y, v.z);
    corners[i] = glm::vec3(glm::dot(turned, lines.right), glm::dot(turned, lines.up), glm::dot(turned, lines.depth));
  }
  for (const auto* triangles : {&mesh.leaf_triangles, &mesh.wood_triangles})
    for (const glm::uvec3& t : *triangles)
      for (int corner = 0; corner < 3; ++corner) box.include(corners[t[corner]]);
  TreePicture picture;
  picture.low = glm::ivec2(glm::floor(glm::vec2(box.low)));
  picture.size = glm::ivec2(glm::floor(glm::vec2(box.high))) - picture.low + 1;
  const auto pixels = static_cast<std::size_t>(picture.size.x) * static_cast<std::size_t>(picture.size.y);
  picture.depth.assign(pixels, kNothing);
  picture.side.assign(pixels, 0);
  const detail::PixelGrid grid{
      .corner = glm::dvec2(picture.low), .pixels_per_metre = 1., .columns = picture.size.x, .rows = picture.size.y};
  const detail::ScanConversion scan = detail::scanConversion();
  std::vector<detail::Span> spans(std::max<std::size_t>(4096, static_cast<std::size_t>(grid.rows)));
  const auto draw = [&](const std::vector<glm::uvec3>& triangles, const std::vector<std::uint32_t>& of_triangle) {
    for (std::size_t begin = 0; begin < triangles.size();) {
      const detail::Scanned scanned =
          scan(grid, corners.data(), &triangles[begin], triangles.size() - begin, spans.data(), spans.size());
      for (const detail::Span& span : std::span(spans).first(scanned.spans)) {
        const glm::uvec3& t = triangles[begin + span.triangle];
        const glm::vec3 &a = corners[t.x], &b = corners[t.y], &c = corners[t.z];
        const bool front = ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) < 0.f) != lines.mirrored;
        const std::uint32_t side = 2 * of_triangle[begin + span.triangle] + (front ? 0 : 1);
        const std::size_t at =
            static_cast<std::size_t>(span.row) * static_cast<std::size_t>(picture.size.x) + span.column;
        for (std::uint32_t i = 0; i < span.length; ++i) {
          const float depth = span.depth + static_cast<float>(i) * span.slope;
          if (depth > picture.depth[at + i] || (depth == picture.depth[at + i] && side >= picture.side[at + i]))
            continue;
          picture.depth[at + i] = depth;
          picture.side[at + i] = side;
        }
      }
      begin += scanned.triangles;
    }
  };
  draw(mesh.leaf_triangles, elements.of_leaf_triangle);
  draw(mesh.wood_triangles, elements.of_wood_triangle);
  return picture;
}

// (F3)
void shineOn(std::span<const SunlitTree> trees, const SunLines& lines,
             const std::function<void(std::size_t tree, std::span<const std::uint32_t> of_sides)>& lit,
             const std::function<void(const SunTile& tile)>& seen, const Progress& progress) {
  // Trees by the tiles that they reach into.
  std::map<std::pair<int, int>, std::vector<Copy>> of_tiles;
  const auto place = [&](const Copy& copy, const glm::ivec2& size) {
    glm::ivec2 low = copy.low, high = copy.low + size - 1;
    if (lines.repeat) {
      low = glm::max(low, glm::ivec2(0));
      high = glm::min(high, *lines.repeat - 1);
      if (low.x > high.x || low.y > high.y) return;
    }
    const glm::ivec2 first = floorDiv(low, glm::ivec2(kTile)), last = floorDiv(high, glm::ivec2(kTile));
    for (int y = first.y; y <= last.y; ++y)
      for (int x = first.x; x <= last.x; ++x) of_tiles[{y, x}].push_back(copy);
  };
  std::vector<float> depths;
  for (std::size_t tree = 0; tree < trees.size(); ++tree) {
    const glm::dvec3 position(trees[tree].position);
    depths.push_back(static_cast<float>(glm::dot(position, lines.depth)));
    const glm::ivec2 size = trees[tree].picture->size;
    const glm::ivec2 low =
        trees[tree].picture->low +
        glm::ivec2(glm::round(glm::dvec2(glm::dot(position, lines.right), glm::dot(position, lines.up))));
    if (!lines.repeat) {
      place({tree, low}, size);
      continue;
    }
    const glm::ivec2 home = low - *lines.repeat * floorDiv(low, *lines.repeat);
    const glm::ivec2 before = floorDiv(home + size - 1, *lines.repeat);
    for (int y = 0; y <= before.y; ++y)
      for (int x = 0; x <= before.x; ++x) place({tree, home - glm::ivec2(x, y) * *lines.repeat}, size);
  }
  std::vector<std::pair<glm::ivec2, const std::vector<Copy>*>> tiles;
  for (const auto& [tile, copies] : of_tiles) tiles.push_back({{tile.second, tile.first}, &copies});

  struct Work {
    std::vector<float> depth;
    std::vector<std::uint32_t> lines;
  };
  tbb::enumerable_thread_specific<Work> works;
  SharedProgress tiles_done(progress, static_cast<double>(tiles.size()));
  tbb::parallel_for(std::size_t{0}, tiles.size(), [&](std::size_t number) {
    Work& work = works.local();
    const glm::ivec2 corner = tiles[number].first * kTile;
    glm::ivec2 end = corner + kTile;
    if (lines.repeat) end = glm::min(end, *lines.repeat);
    work.depth.assign(static_cast<std::size_t>(kTile) * kTile, kNothing);
    // Calls with places in the tile and in the picture of each pixel that both have.
    const auto each = [&](const Copy& copy, const auto& pixel) {
      const TreePicture& picture = *trees[copy.tree].picture;
      const glm::ivec2 first = glm::max(corner, copy.low), last = glm::min(end, copy.low + picture.size);
      for (int y = first.y; y < last.y; ++y) {
        const std::size_t in_tile = static_cast<std::size_t>((y - corner.y) * kTile - corner.x);
        const std::size_t in_picture =
            static_cast<std::size_t>(y - copy.low.y) * static_cast<std::size_t>(picture.size.x) -
            static_cast<std::size_t>(copy.low.x);
        for (int x = first.x; x < last.x; ++x)
          pixel(in_tile + static_cast<std::size_t>(x), in_picture + static_cast<std::size_t>(x));
      }
    };
    for (const Copy& copy : *tiles[number].second) {
      const TreePicture& picture = *trees[copy.tree].picture;
      const float more = depths[copy.tree];
      each(copy, [&](std::size_t at, std::size_t from) {
        work.depth[at] = std::min(work.depth[at], picture.depth[from] + more);
      });
    }
    for (const Copy& copy : *tiles[number].second) {
      const TreePicture& picture = *trees[copy.tree].picture;
      const float more = depths[copy.tree];
      work.lines.assign(trees[copy.tree].sides, 0);
      LitPixels* const pixels = trees[copy.tree].pixels;
      bool any = false;
      std::size_t word = 0;
      std::uint64_t of_word = 0;
      each(copy, [&](std::size_t at, std::size_t from) {
        const float depth = picture.depth[from] + more;
        if (depth == kNothing || depth > work.depth[at]) return;
        ++work.lines[picture.side[from]];
        any = true;
        if (!pixels) return;
        if (from / LitPixels::kBits != word) {
          if (of_word != 0) pixels->add(word, of_word);
          word = from / LitPixels::kBits;
          of_word = 0;
        }
        of_word |= std::uint64_t{1} << (from % LitPixels::kBits);
      });
      if (of_word != 0) pixels->add(word, of_word);
      if (any) lit(copy.tree, work.lines);
    }
    if (seen) seen({corner, end - corner, kTile, work.depth});
    tiles_done.add();
  });
}

}  // namespace sunfleck
