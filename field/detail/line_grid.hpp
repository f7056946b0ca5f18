#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/directions.hpp"
#include "core/tree_mesh.hpp"
#include "field/elements.hpp"
#include "grid/detail/scan_conversion.hpp"

// Parallel lines through a stand, one through each pixel of a grid across them, and where they cross its elements.
namespace sunfleck::detail {

// A place where a line crosses an element, as a number that is greater the farther it lies along the line: its depth in
// the upper half, and in the lower the number of the side that the line comes to, 2 element for the front and
// 2 element + 1 for the back.
using Crossing64 = std::uint64_t;
inline std::uint32_t sideMet(Crossing64 crossing) {
  return static_cast<std::uint32_t>(crossing);
}
inline Crossing64 crossing64(float depth, std::uint32_t side) {
  constexpr std::uint32_t kSign = 1u << 31;
  const auto bits = std::bit_cast<std::uint32_t>(depth);
  return Crossing64{bits & kSign ? ~bits : bits | kSign} << 32 | side;
}
inline float depthOf(Crossing64 crossing) {
  constexpr std::uint32_t kSign = 1u << 31;
  const auto bits = static_cast<std::uint32_t>(crossing >> 32);
  return std::bit_cast<float>(bits & kSign ? bits ^ kSign : ~bits);
}

// Sides of a stand's elements.
struct StandSurfaces {
  const TreeMesh* mesh;
  const FieldElements* elements;
  std::optional<glm::vec2> period;  // side lengths of the repeated rectangle [m]
};

// The lines of one direction. Without period their pixels are square and cover the stand across the direction; with
// one, they cover a period as the direction sees it from the ground, and lines repeat as the stand does.
class LineGrid {
 public:
  //   area    that `finer` lines of a row stand for, across them [m^2]; with a period about, as pixels are whole
  //   offset  of the pixels' grid, in pixels [1], 0 .. 1
  //   finer   pixels' height by their width [1]
  LineGrid(const StandSurfaces& surfaces, Direction along, double area, glm::dvec2 offset, int finer = 1);

  double lineArea() const { return line_area_; }  // [m^2]
  std::size_t lines() const { return static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y); }
  glm::ivec2 size() const { return size_; }

  // Where a line is at a depth [m]; with a period, but for whole periods.
  glm::vec3 place(int column, int row, float depth) const {
    return corner_ + static_cast<float>(column) * column_step_ + static_cast<float>(row) * row_step_ + depth * along_;
  }
  // The column and row of the pixel that a place lies in; column -1 if in none. And the place's depth, as of crossings
  // [m].
  glm::ivec2 pixelAt(const glm::vec3& place, float& depth) const {
    glm::vec2 pixel(glm::dot(place, right_) - shift_.x, glm::dot(place, up_) - shift_.y);
    depth = glm::dot(place, depth_);
    if (surfaces_.period) {
      const glm::vec2 periods = pixel * per_size_;
      // Rounds down, without the call that std::floor is on old processors.
      const glm::vec2 whole(static_cast<float>(static_cast<int>(periods.x) - (periods.x < 0.f)),
                            static_cast<float>(static_cast<int>(periods.y) - (periods.y < 0.f)));
      pixel -= whole * glm::vec2(size_);
    }
    const glm::ivec2 whole(pixel);
    if (pixel.x < 0.f || pixel.y < 0.f || whole.x >= size_.x || whole.y >= size_.y) return {-1, 0};
    return whole;
  }

  // Triangles of the stand: those of leaves, then those of wood.
  std::size_t triangles() const;
  // Calls put(line, crossing) for each crossing of triangles [begin, end).
  template <typename Put>
  void cross(std::size_t begin, std::size_t end, std::vector<Span>& work, const Put& put) const {
    const auto columns = static_cast<std::uint32_t>(size_.x);
    forSpans(begin, end, work, [&](const Span& span, std::uint32_t side) {
      std::uint32_t column = span.column;
      for (std::uint32_t i = 0; i < span.length; ++i) {
        put(std::size_t{span.row} * columns + column,
            crossing64(span.depth + static_cast<float>(i) * span.slope, side));
        if (++column == columns) column = 0;
      }
    });
  }
  // Calls put(span, side) for each row of pixels that triangles [begin, end) cover, with the side of an element that
  // lines come to. With a period a span goes round where it passes the end of its row.
  template <typename Put>
  void forSpans(std::size_t begin, std::size_t end, std::vector<Span>& work, const Put& put) const {
    const std::size_t leaves = surfaces_.mesh->leaf_triangles.size();
    forSpansOf(surfaces_.mesh->leaf_triangles, surfaces_.elements->of_leaf_triangle, std::min(begin, leaves),
               std::min(end, leaves), work, put);
    forSpansOf(surfaces_.mesh->wood_triangles, surfaces_.elements->of_wood_triangle, std::max(begin, leaves) - leaves,
               std::max(end, leaves) - leaves, work, put);
  }

 private:
  // Whether a line comes to a triangle from its front.
  bool fromFront(const glm::uvec3& triangle) const {
    const glm::vec3 &a = projected_[triangle.x], &b = projected_[triangle.y], &c = projected_[triangle.z];
    return ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) < 0.f) != mirrored_;
  }

  template <typename Put>
  void forSpansOf(const std::vector<glm::uvec3>& triangles, const std::vector<std::uint32_t>& elements,
                  std::size_t begin, std::size_t end, std::vector<Span>& work, const Put& put) const {
    constexpr std::size_t kRoom = 4096;
    work.resize(std::max(kRoom, static_cast<std::size_t>(pixels_.rows)));
    while (begin < end) {
      const Scanned scanned =
          scan_(pixels_, projected_.data(), &triangles[begin], end - begin, work.data(), work.size());
      for (Span span : std::span(work).first(scanned.spans)) {
        const std::size_t triangle = begin + span.triangle;
        if (surfaces_.period) {  // of which the stand's pixels may go round several; divisions take long
          span.row %= static_cast<std::uint32_t>(size_.y);
          span.column %= static_cast<std::uint32_t>(size_.x);
        }
        put(span, 2 * elements[triangle] + !fromFront(triangles[triangle]));
      }
      begin += scanned.triangles;
    }
  }

  StandSurfaces surfaces_;
  std::vector<glm::vec3> projected_;  // of the vertices: right, up [pixel], depth [m]
  bool mirrored_ = false;             // whether right, up and depth are left-handed
  PixelGrid pixels_{};                // of the stand; with a period they may go round it several times
  glm::ivec2 size_{0};
  glm::vec2 per_size_{0.f};  // 1 / size_
  double line_area_ = 0.;
  glm::vec3 right_{}, up_{}, depth_{};               // which give a place's pixel, but for shift_, and depth
  glm::vec2 shift_{};                                // [pixel]
  glm::vec3 corner_{}, column_step_{}, row_step_{};  // of the middles of pixels at depth 0 [m]
  glm::vec3 along_{};                                // [m] per depth
  ScanConversion scan_ = scanConversion();
};

}  // namespace sunfleck::detail
