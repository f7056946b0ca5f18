// Compiled once for each instruction set (sunfleck_kernel in cmake/module.cmake).
#include "field/detail/sweep_row.hpp"

namespace sunfleck::SUNFLECK_ISA {
namespace {

constexpr std::size_t kLanes = detail::kSweepLanes;
typedef float Floats __attribute__((vector_size(kLanes * sizeof(float))));
typedef std::int32_t Integers __attribute__((vector_size(kLanes * sizeof(float))));

[[gnu::always_inline]] inline Floats load(const float* from) {
  Floats lanes;
  __builtin_memcpy(&lanes, from, sizeof(lanes));
  return lanes;
}
[[gnu::always_inline]] inline void store(Floats lanes, float* to) {
  __builtin_memcpy(to, &lanes, sizeof(lanes));
}
[[gnu::always_inline]] inline bool any(Integers where) {
  std::int32_t found = 0;
  for (std::size_t lane = 0; lane < kLanes; ++lane) found |= where[lane];
  return found != 0;
}

constexpr float kOutward = detail::kOutwardShare, kOut = 1.f / kOutward, kIn = kOut - 1.f;

struct Faces {
  Floats x, y, z;
};

// (F14) What a cell sends out where its diamond would send less than nothing through a face: nothing through that face,
// and the mean anew from the balance that is left, so that no light is made. At most three times, for one face more
// each.
[[gnu::noinline]] Floats fixedUp(const Floats rate[3], Floats extinction, Floats source, const Faces& in, Faces& out) {
  Integers closed_x{}, closed_y{}, closed_z{};
  Floats mean{};
  for (int round = 0; round < 3; ++round) {
    closed_x |= out.x < 0.f;
    closed_y |= out.y < 0.f;
    closed_z |= out.z < 0.f;
    const Floats none{};
    const Floats open_x = closed_x ? none : rate[0], open_y = closed_y ? none : rate[1],
                 open_z = closed_z ? none : rate[2];
    const Floats all = rate[0] * in.x + rate[1] * in.y + rate[2] * in.z,
                 open = open_x * in.x + open_y * in.y + open_z * in.z;
    const Floats gained = source + open + kOutward * (all - open);
    const Floats lost = extinction + open_x + open_y + open_z;
    mean = lost > 0.f ? gained / lost : none;
    out.x = closed_x ? none : kOut * mean - kIn * in.x;
    out.y = closed_y ? none : kOut * mean - kIn * in.y;
    out.z = closed_z ? none : kOut * mean - kIn * in.z;
    if (!any((out.x < 0.f) | (out.y < 0.f) | (out.z < 0.f))) break;
  }
  return mean;
}

[[gnu::always_inline]] inline Floats cell(const Floats rate[3], Floats extinction, Floats per_lost, Floats source,
                                          float* face_x, float* face_y, float* face_z) {
  const Faces in{load(face_x), load(face_y), load(face_z)};
  Floats mean = (source + rate[0] * in.x + rate[1] * in.y + rate[2] * in.z) * per_lost;
  Faces out{kOut * mean - kIn * in.x, kOut * mean - kIn * in.y, kOut * mean - kIn * in.z};
  if (any((out.x < 0.f) | (out.y < 0.f) | (out.z < 0.f))) mean = fixedUp(rate, extinction, source, in, out);
  store(out.x, face_x);
  store(out.y, face_y);
  store(out.z, face_z);
  return mean;
}

void sweep(const detail::SweptRow& row, glm::ivec2 begin, glm::ivec2 end) {
  const Floats rate[3] = {load(row.rate[0]), load(row.rate[1]), load(row.rate[2])};
  const Floats streaming = rate[0] + rate[1] + rate[2], per_streaming = 1.f / streaming;
  const std::size_t stride = row.bands * kLanes;
  const auto place = [](bool backward, int from, int to, int i) { return backward ? to - 1 - i : from + i; };
  for (int k = 0; k < row.size.z; ++k) {
    const int z = place(row.backward[2], 0, row.size.z, k);
    for (int j = 0; j < end.y - begin.y; ++j) {
      const int y = place(row.backward[1], begin.y, end.y, j);
      float* const face_x = row.face_x + static_cast<std::size_t>(z * row.size.y + y) * stride;
      const std::uint32_t* const slots =
          row.slot + static_cast<std::size_t>(z * row.size.y + y) * static_cast<std::size_t>(row.size.x);
      for (int i = 0; i < end.x - begin.x; ++i) {
        const int x = place(row.backward[0], begin.x, end.x, i);
        float* const face_y = row.face_y + static_cast<std::size_t>(z * row.size.x + x) * stride;
        float* const face_z = row.face_z + static_cast<std::size_t>(y * row.size.x + x) * stride;
        const std::uint32_t slot = slots[x];
        if (slot == row.none) {
          for (std::size_t at = 0; at < stride; at += kLanes)
            cell(rate, Floats{}, per_streaming, Floats{}, face_x + at, face_y + at, face_z + at);
          continue;
        }
        const Floats extinction = load(row.extinction + slot * kLanes);
        const Floats per_lost = 1.f / (extinction + streaming);
        const float* const source = row.source + slot * stride;
        float* const mean = row.mean + slot * stride;
        for (std::size_t at = 0; at < stride; at += kLanes)
          store(cell(rate, extinction, per_lost, load(source + at), face_x + at, face_y + at, face_z + at), mean + at);
      }
    }
  }
}

}  // namespace

extern const detail::SweepRow sweep_row;
const detail::SweepRow sweep_row = sweep;

}  // namespace sunfleck::SUNFLECK_ISA
