// Compiled once for each instruction set (sunfleck_kernel in cmake/module.cmake).
#include "grid/detail/part_walk.hpp"

namespace sunfleck::SUNFLECK_ISA {
namespace {

constexpr int kLanes = SUNFLECK_VECTOR_BYTES / sizeof(float);
constexpr float kInfinity = __builtin_inff();
constexpr float kLevel = 1e-9f;  // of an axis along which a line does not move
typedef float Floats __attribute__((vector_size(SUNFLECK_VECTOR_BYTES)));
typedef std::int32_t Integers __attribute__((vector_size(SUNFLECK_VECTOR_BYTES)));

[[gnu::always_inline]] inline Floats least(Floats a, Floats b) {
  return a < b ? a : b;
}
[[gnu::always_inline]] inline Floats most(Floats a, Floats b) {
  return a < b ? b : a;
}
[[gnu::always_inline]] inline Floats load(const float* from) {
  Floats lanes;
  __builtin_memcpy(&lanes, from, sizeof(lanes));
  return lanes;
}
template <typename Vector, typename Number>
[[gnu::always_inline]] inline void store(Vector lanes, Number* to) {
  __builtin_memcpy(to, &lanes, sizeof(lanes));
}
[[gnu::always_inline]] inline bool any(Integers where) {
  bool found = false;
  for (int lane = 0; lane < kLanes; ++lane) found |= where[lane] != 0;
  return found;
}

void walk(const detail::PartGrid& grid, const glm::vec3& along, const float* from, const detail::PassedParts& passed) {
  const float low[3] = {grid.low.x, grid.low.y, grid.low.z}, high[3] = {grid.high.x, grid.high.y, grid.high.z};
  const float move[3] = {along.x, along.y, along.z};
  const std::int32_t size[3] = {grid.size.x, grid.size.y, grid.size.z};
  Floats begin = Floats{} - kInfinity, last = Floats{} + kInfinity, start[3], per_metre[3];
  for (int axis = 0; axis < 3; ++axis) {
    start[axis] = load(from + axis * kLanes);
    const bool level = move[axis] < kLevel && move[axis] > -kLevel;
    per_metre[axis] = Floats{} + (level ? 0.f : 1.f / move[axis]);
    if (level) {
      last = start[axis] >= low[axis] ? last : Floats{} - kInfinity;
      last = start[axis] <= high[axis] ? last : Floats{} - kInfinity;
    } else {
      const Floats a = (low[axis] - start[axis]) * per_metre[axis], b = (high[axis] - start[axis]) * per_metre[axis];
      begin = most(begin, least(a, b));
      last = least(last, most(a, b));
    }
  }
  Integers count{};
  store(begin, passed.begin);
  store(count, passed.count);
  if (!any(begin < last)) return;

  Floats next[3], way[3];
  Integers part{}, turn[3];
  std::int32_t stride = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const bool level = per_metre[axis][0] == 0.f, up = move[axis] > 0.f;
    const Floats entry = (start[axis] + begin * move[axis] - low[axis]) * (1.f / grid.side);
    const Integers cell =
        __builtin_convertvector(least(most(entry, Floats{}), Floats{} + static_cast<float>(size[axis] - 1)), Integers);
    const Floats plane = low[axis] + grid.side * (__builtin_convertvector(cell, Floats) + (up ? 1.f : 0.f));
    next[axis] = level ? Floats{} + kInfinity : (plane - start[axis]) * per_metre[axis];
    way[axis] = Floats{} + grid.side * (up ? per_metre[axis][0] : -per_metre[axis][0]);
    turn[axis] = Integers{} + (up ? stride : -stride);
    part += cell * stride;
    stride *= size[axis];
  }
  const std::size_t most_steps = static_cast<std::size_t>(size[0] + size[1] + size[2]) + 4;
  Floats at = begin;
  Integers going = begin < last;  // -1 where true
  for (std::size_t step = 0; step < most_steps; ++step) {
    const Floats nearest = least(next[0], least(next[1], next[2])), end = least(most(nearest, at), last);
    store(end - at, passed.length + step * kLanes);
    store(end, passed.end + step * kLanes);
    store(part, passed.part + step * kLanes);
    count -= going;
    going &= nearest < last;
    if (!any(going)) break;
    at = end;
    const Integers across_x = next[0] <= nearest;
    const Integers across_y = (next[1] <= nearest) & ~across_x;
    const Integers across_z = ~across_x & ~across_y;
    next[0] = across_x ? next[0] + way[0] : next[0];
    next[1] = across_y ? next[1] + way[1] : next[1];
    next[2] = across_z ? next[2] + way[2] : next[2];
    part += (across_x & turn[0]) + (across_y & turn[1]) + (across_z & turn[2]);
  }
  store(count, passed.count);
}

}  // namespace

extern const detail::PartWalk part_walk;
constinit const detail::PartWalk part_walk{kLanes, walk};

}  // namespace sunfleck::SUNFLECK_ISA
