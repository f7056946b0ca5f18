// Compiled once for each instruction set (sunfleck_kernel in cmake/module.cmake).
#include "grid/detail/scan_conversion.hpp"

namespace sunfleck::SUNFLECK_ISA {
namespace {

using detail::PixelGrid;
using detail::Scanned;
using detail::Span;

constexpr int kLanes = SUNFLECK_VECTOR_BYTES / sizeof(double);
constexpr int kRows = 8;  // looked at together
typedef double Doubles __attribute__((vector_size(SUNFLECK_VECTOR_BYTES)));
typedef std::int64_t Longs __attribute__((vector_size(SUNFLECK_VECTOR_BYTES)));
typedef std::int8_t Bytes __attribute__((vector_size(kLanes)));
typedef std::int32_t Integers __attribute__((vector_size(SUNFLECK_VECTOR_BYTES / 2)));

// In pixels, where the centre of pixel (x, y) is at (x + 1, y + 1) and nothing is below 0, so that the whole part of a
// column is the first pixel whose centre lies to the right of it.
struct Corner {
  double column, row, depth;
};

// An edge of a triangle. Whatever it tells, it computes from its ends alone, in the same order of them, so that the two
// triangles on either side of it see the same.
struct Edge {
  Corner high, slope;  // upper end, and change per row; .row of the latter is not used

  [[gnu::always_inline]] Edge(const Corner& low_end, const Corner& high_end) : high(high_end) {
    const double per_row = 1. / (high.row - low_end.row);
    slope.column = per_row * (high.column - low_end.column);
    slope.depth = per_row * (high.depth - low_end.depth);
  }
};

// 0, 1, 2 ... in the lanes of a vector.
template <typename Vector, typename Number>
[[gnu::always_inline]] inline Vector countedFrom0() {
  constexpr Number numbers[] = {0, 1, 2, 3, 4, 5, 6, 7};
  Vector counted;
  __builtin_memcpy(&counted, numbers, sizeof counted);
  return counted;
}

Doubles all(double value) {
  return value - Doubles{};
}

template <typename T>
[[gnu::always_inline]] inline T min(T a, T b) {
  return b < a ? b : a;
}
template <typename T>
[[gnu::always_inline]] inline T max(T a, T b) {
  return a < b ? b : a;
}

// Appends the spans of a triangle, and returns the end of all.
[[gnu::always_inline]] inline Span* scanTriangle(const PixelGrid& pixels, const Corner (&corners)[3],
                                                 std::uint32_t triangle, Span* span) {
  const auto& [a, b, c] = corners;
  // The corners from low to high, by whether b is below a, c below b and c below a: without branches, as no processor
  // foresees them.
  static constexpr std::uint8_t kOrder[8][3] = {{0, 1, 2}, {1, 0, 2}, {0, 2, 1}, {},
                                                {},        {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  const auto& order = kOrder[(b.row < a.row) + 2 * (c.row < b.row) + 4 * (c.row < a.row)];
  const Corner &low = corners[order[0]], &middle = corners[order[1]], &high = corners[order[2]];
  const int first_row = static_cast<int>(low.row), bend = static_cast<int>(middle.row);
  const int end_row = min(pixels.rows, static_cast<int>(high.row));
  if (first_row >= end_row || static_cast<int>(min(a.column, min(b.column, c.column))) ==
                                  static_cast<int>(max(a.column, max(b.column, c.column))))
    return span;  // between the centres of pixels

  const Edge whole(low, high), parts[2] = {Edge(low, middle), Edge(middle, high)};
  for (int row = first_row; row < end_row; row += kRows) {
    double columns[kRows], others[kRows];
    std::int32_t first[kRows], end[kRows];
    std::uint64_t met = 0;  // a byte for each row that has pixels
    for (int lane = 0; lane < kRows && row + lane < end_row; lane += kLanes) {
      const Doubles centre = countedFrom0<Doubles, double>() + (row + lane + 1.);
      const Longs upper = centre > all(bend);
      const Doubles column = whole.high.column + (centre - whole.high.row) * whole.slope.column;
      const Doubles from_column = upper ? all(parts[1].high.column) : all(parts[0].high.column);
      const Doubles from_row = upper ? all(parts[1].high.row) : all(parts[0].high.row);
      const Doubles slope = upper ? all(parts[1].slope.column) : all(parts[0].slope.column);
      const Doubles other = from_column + (centre - from_row) * slope;
      Integers first_pixel = __builtin_convertvector(min(column, other), Integers);
      Integers end_pixel = __builtin_convertvector(max(column, other), Integers);
      first_pixel = max(first_pixel, Integers{});
      end_pixel = min(end_pixel, pixels.columns - Integers{});
      const Integers has_pixels =
          (first_pixel < end_pixel) & (countedFrom0<Integers, std::int32_t>() < end_row - row - lane);
      const Bytes bytes = __builtin_convertvector(has_pixels, Bytes);
      std::uint64_t of_lanes = 0;
      __builtin_memcpy(&of_lanes, &bytes, sizeof bytes);
      met |= (of_lanes & 0x0101010101010101u) << 8 * lane;
      __builtin_memcpy(columns + lane, &column, sizeof column);
      __builtin_memcpy(others + lane, &other, sizeof other);
      __builtin_memcpy(first + lane, &first_pixel, sizeof first_pixel);
      __builtin_memcpy(end + lane, &end_pixel, sizeof end_pixel);
    }
    for (; met != 0; met &= met - 1, ++span) {
      const int i = __builtin_ctzll(met) / 8;
      const double centre = row + i + 1.;
      const Edge& part = parts[row + i >= bend];
      const double depth = whole.high.depth + (centre - whole.high.row) * whole.slope.depth;
      const double other_depth = part.high.depth + (centre - part.high.row) * part.slope.depth;
      const double slope = (other_depth - depth) / (others[i] - columns[i]);
      *span = {static_cast<std::uint32_t>(row + i),
               static_cast<std::uint32_t>(first[i]),
               static_cast<std::uint32_t>(end[i] - first[i]),
               static_cast<float>(depth + (first[i] + 1. - columns[i]) * slope),
               static_cast<float>(slope),
               triangle};
    }
  }
  return span;
}

Scanned scan(const PixelGrid& pixels, const glm::vec3* corners, const glm::uvec3* triangles, std::size_t count,
             Span* spans, std::size_t room) {
  const auto inPixels = [&](std::uint32_t i) {
    return Corner{(double{corners[i].x} - pixels.corner.x) * pixels.pixels_per_metre + 0.5,
                  (double{corners[i].y} - pixels.corner.y) * pixels.pixels_per_metre + 0.5, double{corners[i].z}};
  };
  Span* next = spans;
  std::size_t i = 0;
  for (; i < count && static_cast<std::size_t>(spans + room - next) >= static_cast<std::size_t>(pixels.rows); ++i) {
    const glm::uvec3& t = triangles[i];
    next = scanTriangle(pixels, {inPixels(t.x), inPixels(t.y), inPixels(t.z)}, static_cast<std::uint32_t>(i), next);
  }
  return {i, static_cast<std::size_t>(next - spans)};
}

}  // namespace

extern const detail::ScanConversion scan_conversion;
constinit const detail::ScanConversion scan_conversion = scan;

}  // namespace sunfleck::SUNFLECK_ISA
